// SPDX-License-Identifier: Apache-2.0
// Which material a place of the surface has, given the light: every vertex is asked how well each of a ladder
// of materials explains its samples, when its own color is free.
#pragma once

#include <vector>

#include "engine/reconstruct/appearance/split_system.h"

namespace cei3d {

// Of each hypothesis, a dielectric or a metal with the roughness of a level of BlurLadder: the mean weighted
// squared error over the samples of a vertex.
struct MaterialEvidence {
  static constexpr int kHypotheses = 2 * BlurLadder::kLevels;  // dielectrics first
  std::vector<float> error;                                    // [#V][kHypotheses]
  std::vector<float> samples;                                  // #V
  const float* of(size_t vertex) const { return &error[vertex * kHypotheses]; }
};

// max_diffuse: #V, radiance that a white dielectric would send out. colors: #rows, SplitSystem::targets().
MaterialEvidence material_evidence(const Mesh&, const std::vector<SplitRow>&, std::span<const Vec3f> colors,
                                   BlurLadder&, const std::vector<Vec3f>& light,
                                   const std::vector<Vec3f>& max_diffuse);

// The mean over each vertex's surroundings of similar color. colors: #V, display-encoded. rounds: steps of
// diffusion from vertex to vertex.
void diffuse_evidence(const Mesh&, const std::vector<Vec3f>& colors, int rounds, MaterialEvidence&);

// The best dielectric and the best metal of a vertex, their roughness between the levels.
struct BestMaterials {
  float dielectric_roughness, metal_roughness;
  float dielectric_error, metal_error;
};
BestMaterials best_materials(const float* errors);

// Mean display-encoded color of each vertex's samples. #V
std::vector<Vec3f> mean_colors(const Mesh&, const std::vector<SplitRow>&);

// The factor on the light, per channel, that fits the dielectrics' samples best when the diffuse radiance of
// every vertex is free; and how sharply: the curvature of the squared error by that factor.
struct LightScale {
  Vec3f factor, curvature;
};
LightScale light_scale(const Mesh&, const std::vector<SplitRow>&, std::span<const Vec3f> colors, BlurLadder&,
                       const std::vector<Vec3f>& light, const SplitMaterials&);

}  // namespace cei3d
