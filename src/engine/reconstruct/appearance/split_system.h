// SPDX-License-Identifier: Apache-2.0
// The equations of the linear split for given materials, and their solution by conjugate gradients.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "core/math/reflection_axis.h"
#include "engine/reconstruct/appearance/light_harmonics.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/reconstruct/appearance/lobe_blur.h"
#include "model/light/envmap.h"

namespace cei3d {

// What a sample says, materials aside.
struct SplitRow {
  std::array<uint32_t, 3> vertices;  // around the hit
  std::array<float, 3> barycentric;
  Vec3f normal, to_camera;               // unit, in the frame of the light
  float nv;                              // their cosine
  bool blocked;                          // the mirror ray meets the surface again,
  std::array<uint32_t, 3> far_vertices;  // between these vertices
  std::array<float, 3> far_barycentric;
  Vec3f color;      // linear
  Vec3f weight;     // squared slope of the display curve
  uint8_t clipped;  // SurfaceSamples::clipped
  // Under a light that turns: how much light the vertices get in this view, over their mean.
  uint16_t view = 0;
  Vec3f diffuse_light{1, 1, 1}, far_diffuse_light{1, 1, 1};
};

// How the rows' diffuse radiance follows a change of a light that turns.
struct DiffuseSlopes {
  struct OfRow {
    Harmonics by_light;  // of the irradiance over its mean, times that mean
    Vec3f gain;          // D over the mean irradiance
  };
  std::vector<OfRow> rows;  // empty: it does not
  HarmonicLight light{};    // from which on the change counts
};

std::vector<SplitRow> make_split_rows(const Surface&, const SurfaceSamples&, const LinearSplitOptions&);

inline Vec3f between(const std::vector<Vec3f>& values, const std::array<uint32_t, 3>& v,
                     const std::array<float, 3>& b) {
  return values[v[0]] * b[0] + values[v[1]] * b[1] + values[v[2]] * b[2];
}

// A light blurred by the lobes of a ladder of roughnesses; in between the blurs are interpolated.
class BlurLadder {
 public:
  explicit BlurLadder(int light_height) : height_(light_height) {}

  static constexpr int kLevels = 10;
  static float roughness(int level);
  struct Place {
    int level = 0;    // and the next one
    float above = 0;  // share of the next one
  };
  static Place place(float roughness);

  const LobeBlur& level(int i);  // made on first use
  int height() const { return height_; }

 private:
  int height_;
  std::array<std::unique_ptr<LobeBlur>, kLevels> blurs_;
};

// Materials of the vertices as the split sees them: metalness is 0 or 1.
struct SplitMaterials {
  std::vector<Material> of;  // #V
  std::vector<Vec3f> color;  // #V, base color of the metals
  bool is_metal(uint32_t v) const { return of[v].metalness > 0.5f; }
};
inline SplitMaterials one_material(size_t vertices, const Material& m) {
  return {std::vector<Material>(vertices, m), std::vector<Vec3f>(vertices, Vec3f{0.7f, 0.7f, 0.7f})};
}

struct SplitUnknowns {
  std::vector<Vec3f> diffuse;  // #V
  std::vector<Vec3f> light;    // #cells
};

// The part of the sky that a row reflects by a part of the split sum, if its surface has that roughness.
struct ReflectedSky {
  BlurLadder::Place lobe;
  EnvTaps taps;
};
ReflectedSky reflected_sky(const SplitRow&, ReflectionPart, float roughness, int light_height);

using Blurred = std::array<std::vector<Vec3f>, BlurLadder::kLevels>;  // a light; empty: a level not in use
Vec3f radiance_at(const Blurred&, const ReflectedSky&);

class SplitSystem {
 public:
  SplitSystem(const Mesh& mesh, const std::vector<SplitRow>& rows, const LinearSplitOptions& options);

  // Metals have no D, and their samples whose mirror ray is blocked are left out.
  void set_materials(SplitMaterials);
  const SplitMaterials& materials() const { return materials_; }
  void set_diffuse_slopes(DiffuseSlopes slopes) { slopes_ = std::move(slopes); }

  // Improves x by rounds of conjugate gradients, light and D kept >= 0, clipped channels at least what they
  // show.
  void solve(SplitUnknowns& x, int rounds, int steps);
  double residual(const SplitUnknowns& x) const;  // mean of weight * error^2 over samples that mirror the sky
  // Base color per vertex that fits best under the light if all were metal: #V. Clipped channels as of the
  // last solve().
  std::vector<Vec3f> fit_metal_color(const SplitUnknowns& x);

  // What the rows show; of a clipped channel what x predicts, where that is more. #rows
  std::vector<Vec3f> targets(const SplitUnknowns& x) const;

  BlurLadder& blurs() { return blurs_; }
  const std::vector<SplitRow>& rows() const { return rows_; }

 private:
  // What the materials make of a row.
  struct Optics {
    bool used = true;
    ReflectedSky base, fresnel;
    SplitSum<float> split_sum;
    Vec3f base_gain;     // fraction of what `base` sees that the viewer gets; split_sum.bias of `fresnel`
    float diffuse_view;  // of D towards the viewer; 0 at metals
    Vec3f gain() const { return base_gain + Vec3f{split_sum.bias, split_sum.bias, split_sum.bias}; }
  };
  Optics optics_of(const SplitRow&) const;
  // What the rows see of a light.
  struct Sky {
    Blurred blurred;
    HarmonicLight harmonics;
  };
  Sky sky_of(const std::vector<Vec3f>& light) const;
  Sky sky_change(const std::vector<Vec3f>& light) const;  // harmonics from those of the slopes on
  Vec3f predict(size_t row, const SplitUnknowns&, const Sky&) const;
  void smooth(const SplitUnknowns& x, SplitUnknowns& out) const;  // out += gradient of the priors
  void release_bounds(const SplitUnknowns& x);                    // sets weights_
  template <class F>
  void accumulate(F row_value, SplitUnknowns& out) const;         // out = A^T (weight * row_value(row))
  void normal(const SplitUnknowns& x, SplitUnknowns& out) const;  // out = (A^T W A + priors) x
  void right_side(SplitUnknowns& out) const;                      // out = A^T W c
  SplitUnknowns diagonal() const;
  void descend(SplitUnknowns& x, const SplitUnknowns& inverse, int steps) const;

  const Mesh& mesh_;
  const std::vector<SplitRow>& rows_;
  std::vector<Vec3f> weights_;  // of the rows; 0 where a clipped channel is brighter than it shows already
  LinearSplitOptions options_;
  std::vector<std::array<uint32_t, 2>> edges_;
  mutable BlurLadder blurs_;
  LightHarmonics harmonics_;
  DiffuseSlopes slopes_;
  SplitMaterials materials_;
  std::vector<Optics> optics_;  // #rows
  std::array<bool, BlurLadder::kLevels> in_use_{};
  float light_smoothness_ = 0, diffuse_smoothness_ = 0;
};

}  // namespace cei3d
