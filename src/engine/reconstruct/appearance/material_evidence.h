// SPDX-License-Identifier: Apache-2.0
// What the samples of a surface say when the light is known: which material a place has, and how strong the
// light is. Every vertex is asked with its own color free.
#pragma once

#include <vector>

#include "engine/reconstruct/appearance/light_scale.h"
#include "engine/reconstruct/appearance/split_system.h"

namespace cei3d {

// The squared error that hypotheses leave: a dielectric or a metal with the roughness of each level of
// BlurLadder.
struct MaterialEvidence {
  static constexpr int kHypotheses = 2 * BlurLadder::kLevels;  // dielectrics first
  std::vector<float> error;                                    // [#V][kHypotheses], sums over samples
  std::vector<float> samples;                                  // #V
  const float* of(size_t vertex) const { return &error[vertex * kHypotheses]; }
};

class LitSamples {
 public:
  // colors: #rows, SplitSystem::targets(). The rows must outlive the object.
  LitSamples(size_t vertices, const std::vector<SplitRow>& rows, std::vector<Vec3f> colors, BlurLadder&,
             const std::vector<Vec3f>& light);

  // max_diffuse: #V, radiance that a white dielectric would send out.
  MaterialEvidence evidence(const std::vector<Vec3f>& max_diffuse) const;
  // Of the light, by the dielectrics. positions: of the vertices, unit-sphere frame.
  // D of the dielectrics for the light, `before` where there are no samples. #V
  std::vector<Vec3f> fit_diffuse(const SplitMaterials&, std::vector<Vec3f> before) const;
  LightScale light_scale(const SplitMaterials&, const std::vector<Vec3f>& positions) const;

 private:
  // Of a row, if its surface has that roughness.
  struct Seen {
    Vec3f base, fresnel;  // reflected radiance that F0 scales, and the rest
    Vec3f diffuse;        // radiance from that of the vertex
  };
  Seen seen_by(const SplitRow&, float roughness) const;
  int add_errors(uint32_t vertex, int level, Vec3f max_diffuse, float* errors) const;
  std::vector<ReflectionSample> of_dielectric(uint32_t vertex, const Material&) const;
  template <class F>
  int for_samples(uint32_t vertex, float roughness, const F& visit) const;

  const std::vector<SplitRow>& rows_;
  std::vector<Vec3f> colors_;
  int light_height_;
  Blurred sky_;
  std::vector<uint32_t> start_, order_;  // #V + 1; rows by the vertex nearest to them
};

// The best dielectric and the best metal of a vertex, their roughness between the levels.
struct BestMaterials {
  float dielectric_roughness, metal_roughness;
  float dielectric_error, metal_error;
};
BestMaterials best_materials(const float* errors);

// Mean linear color of each vertex's samples, 0 where there are none. #V
std::vector<Vec3f> mean_colors(size_t vertices, const std::vector<SplitRow>&);

// Sums over each vertex's surroundings of similar color in place of its own: steps of diffusion from vertex
// to vertex. colors: #V, linear.
void diffuse_evidence(const Mesh&, const std::vector<Vec3f>& colors, int steps, MaterialEvidence&);

}  // namespace cei3d
