// SPDX-License-Identifier: Apache-2.0
// The equations of the linear split for one roughness, and their solution by conjugate gradients.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/math/shading.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "model/light/envmap.h"

namespace cei3d {

// What a sample says, roughness aside.
struct SplitRow {
  std::array<uint32_t, 3> vertices;  // around the hit
  std::array<float, 3> barycentric;
  float nv;                              // cosine of normal and viewer
  bool blocked;                          // the mirror ray meets the surface again:
  std::array<uint32_t, 3> far_vertices;  // ... here
  std::array<float, 3> far_barycentric;
  EnvTaps taps;     // of the sky along the mirror ray
  Vec3f color;      // linear
  Vec3f weight;     // squared slope of the display curve
  uint8_t clipped;  // SurfaceSamples::clipped
};

std::vector<SplitRow> make_split_rows(const Surface&, const SurfaceSamples&, const LinearSplitOptions&);

// Radiance of the sky blurred by the reflection lobe, on the light's own grid: P = K L. Circulant along the
// columns.
class LobeBlur {
 public:
  LobeBlur(float roughness, int height);
  void apply(const std::vector<Vec3f>& light, std::vector<Vec3f>& blurred) const;
  void apply_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const;
  void apply_squared_transposed(const std::vector<Vec3f>& blurred,
                                std::vector<Vec3f>& light) const;  // entries squared

 private:
  void run(const std::vector<float>& kernel, bool transposed, const std::vector<Vec3f>& in,
           std::vector<Vec3f>& out) const;
  int height_, width_;
  std::vector<float> kernel_;  // [row out][row in][column difference mod width], rows sum to 1
};

struct SplitUnknowns {
  std::vector<Vec3f> diffuse;  // #V
  std::vector<Vec3f> light;    // #cells
};

class SplitSystem {
 public:
  SplitSystem(const Mesh& mesh, const std::vector<SplitRow>& rows, const LinearSplitOptions& options);

  void set_roughness(float roughness);
  float roughness() const { return roughness_; }
  // Base color of a metal: the specular gain becomes color * scale + bias, D stays zero, and samples whose
  // mirror ray is blocked are left out. Empty: a dielectric.
  void set_metal(std::vector<Vec3f> color);

  // Improves x by rounds of conjugate gradients, light kept >= 0, clipped channels at least what they show.
  void solve(SplitUnknowns& x, int rounds, int steps);
  double residual(const SplitUnknowns& x) const;  // mean of weight * error^2 over samples that mirror the sky
  // Base color per vertex that fits best under the light: #V. Clipped channels as of the last solve().
  std::vector<Vec3f> fit_metal_color(const SplitUnknowns& x) const;

 private:
  Vec3f gain(size_t row) const;  // fraction of the reflected radiance that the viewer gets
  Vec3f predict(size_t row, const SplitUnknowns&, const std::vector<Vec3f>& blurred) const;
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
  float roughness_ = 0;
  std::unique_ptr<LobeBlur> blur_;
  std::vector<SplitSum<float>> split_sum_;  // #rows
  std::vector<float> diffuse_view_;         // #rows, of D towards the viewer
  std::vector<Vec3f> metal_;                // #V or empty
  float light_smoothness_ = 0, diffuse_smoothness_ = 0;
};

}  // namespace cei3d
