// SPDX-License-Identifier: Apache-2.0
// The equations of the linear separation for given materials, and their solution by conjugate gradients.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "engine/reconstruct/appearance/blur_ladder.h"
#include "engine/reconstruct/appearance/light_harmonics.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/reconstruct/appearance/split_rows.h"
#include "engine/render/light_direction.h"
#include "model/geometry/mesh/adjacency.h"

namespace cei3d {

// Derivative of the rows' diffuse radiance by a turning light, in spherical harmonics.
struct DiffuseLightGrad {
  struct OfRow {
    Harmonics d_light;  // derivative of (irradiance over its mean), times that mean
    Vec3f gain;         // D over the mean irradiance
  };
  std::vector<OfRow> rows;  // #rows; empty: the light does not turn
  HarmonicLight light{};    // the light at which the derivative was taken
};

// Materials of the vertices in the linear separation: metalness is 0 or 1.
struct SplitMaterials {
  std::vector<Material> of;  // #V
  std::vector<Vec3f> color;  // #V, albedo of the metals, linear
  bool is_metal(uint32_t v) const { return of[v].metalness > 0.5f; }
  double metal_share() const;  // share of the vertices that are metal
};
// With fewer dielectric or metallic vertices than this share, those few determine nothing about the light.
inline constexpr double kFewVertices = 0.02;
inline SplitMaterials one_material(size_t vertices, const Material& m) {
  return {std::vector<Material>(vertices, m), std::vector<Vec3f>(vertices, Vec3f{0.7f, 0.7f, 0.7f})};
}

struct SplitUnknowns {
  std::vector<Vec3f> diffuse;  // #V, diffuse radiance D, linear
  std::vector<Vec3f> light;    // #cells of the lat-long grid, linear radiance
};

class SplitSystem {
 public:
  SplitSystem(const Mesh& mesh, const std::vector<SplitRow>& rows, const LinearSplitOptions& options);

  // Metals have no D.
  void set_materials(SplitMaterials);
  const SplitMaterials& materials() const { return materials_; }
  // Sets the light whose directions Burley's diffuse term depends on. It takes effect at the next
  // set_materials().
  void set_light(const std::vector<Vec3f>& light);
  void set_diffuse_light_grad(DiffuseLightGrad grad) { diffuse_light_grad_ = std::move(grad); }

  // Improves x by rounds of conjugate gradients, with light and D >= 0, and clipped channels as lower bounds.
  void solve(SplitUnknowns& x, int rounds, int steps);
  // The squared error of some rows.
  struct ViewError {
    double sum = 0;    // of weight * error^2 over rows and channels
    double count = 0;  // channels of the rows, each counted by the trust in its row
    double mean() const { return sum / std::max(count, 1.0); }
  };
  // One for each view, by its rows. Where rows are held out, they are of these alone.
  std::vector<ViewError> errors_of_views(const SplitUnknowns& x) const;
  double residual(const SplitUnknowns& x) const;  // mean over the rows of all views
  // Albedo per vertex that fits best under the light if all vertices were metal: #V. Clipped channels are
  // treated as in the last solve().
  std::vector<Vec3f> fit_metal_color(const SplitUnknowns& x);

  // Colors of the rows, with clipped channels raised to the prediction of x: #rows.
  std::vector<Vec3f> targets(const SplitUnknowns& x) const;

  BlurLadder& blurs() { return blurs_; }
  const std::vector<SplitRow>& rows() const { return rows_; }

 private:
  friend struct SplitSystemProbe;  // the test compares the operator with its adjoint
  // Optical coefficients of a row for the present materials.
  struct Optics {
    ReflectedSky base, fresnel;
    SplitSum<float> split_sum;
    ReflectionGains<float> gains;  // of the light along `base` and `fresnel`
    float diffuse_view;            // factor of D, which is 0 for metals
    Vec3f far_gain;                // factor of the radiance of the far point
    // Factor of light that is the same along both lobes, of which so much is seen.
    Vec3f gain_of(float base_seen, float fresnel_seen) const {
      return gains.added_to({0, 0, 0}, Vec3f{1, 1, 1} * base_seen, Vec3f{1, 1, 1} * fresnel_seen);
    }
    Vec3f sky_gain() const { return gain_of(base.open, fresnel.open); }
  };
  Optics optics_of(const SplitRow&) const;
  // A light as the rows read it.
  struct Sky {
    Blurred blurred;
    HarmonicLight harmonics;
  };
  Sky sky_of(const std::vector<Vec3f>& light) const;
  Sky sky_change(const std::vector<Vec3f>& light) const;  // harmonics relative to those of the gradient
  // The part of the row's color that depends on the unknowns, which is all but far_reflected().
  Vec3f predict(size_t row, const SplitUnknowns&, const Sky&) const;
  Vec3f far_reflected(size_t row) const { return optics_[row].far_gain * rows_[row].far_radiance(); }
  void smooth(const SplitUnknowns& x, SplitUnknowns& out) const;  // out += gradient of the priors
  void release_bounds(const SplitUnknowns& x);                    // sets weights_
  struct RowSums;
  struct Chunk {
    size_t begin, end;                    // rows
    uint32_t first_vertex, vertices_end;  // of these rows
  };
  std::vector<Chunk> chunks_of_rows() const;
  size_t cells() const { return size_t(2) * options_.light_height * options_.light_height; }
  void add_row(size_t row, Vec3f y, RowSums&) const;
  void gather_light(const std::vector<RowSums>&, std::vector<Vec3f>& light) const;
  // out = A^T (weight * row_value(row)).
  template <class F>
  void accumulate(F row_value, SplitUnknowns& out) const;
  void normal(const SplitUnknowns& x, SplitUnknowns& out) const;  // out = (A^T W A + priors) x
  void right_side(SplitUnknowns& out) const;                      // out = A^T W c
  SplitUnknowns diagonal() const;
  void descend(SplitUnknowns& x, const SplitUnknowns& inverse, int steps) const;

  const Mesh& mesh_;
  const std::vector<SplitRow>& rows_;
  std::vector<Chunk> chunks_;   // fixed in number, so that sums are the same on any machine
  int views_ = 0;               // number of cameras that rows are of
  std::vector<Vec3f> weights_;  // #rows; 0 where the prediction of a clipped channel is above its color
  LinearSplitOptions options_;
  std::vector<Edge> edges_;
  mutable BlurLadder blurs_;
  LightHarmonics harmonics_;
  LightDirectionMap light_directions_;
  DiffuseLightGrad diffuse_light_grad_;
  SplitMaterials materials_;
  std::vector<Optics> optics_;  // #rows
  std::array<bool, BlurLadder::kLevels> in_use_{};
  float light_smoothness_ = 0, diffuse_smoothness_ = 0;
};

}  // namespace cei3d
