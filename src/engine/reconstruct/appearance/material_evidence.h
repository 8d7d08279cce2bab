// SPDX-License-Identifier: Apache-2.0
// What the samples of a surface say, under a known light, about the material of each vertex and about the
// strength of the light. The color of every vertex is free.
#pragma once

#include <vector>

#include "engine/reconstruct/appearance/light_scale.h"
#include "engine/reconstruct/appearance/split_system.h"
#include "model/geometry/mesh/adjacency.h"

namespace cei3d {

// Squared errors of the samples under each hypothesis: a dielectric or a metal, with the roughness of each
// level of BlurLadder.
struct MaterialEvidence {
  static constexpr int kHypotheses = 2 * BlurLadder::kLevels;  // dielectrics first
  std::vector<float> error;                                    // [#V][kHypotheses], sums over samples
  std::vector<float> samples;                                  // #V
  const float* of(size_t vertex) const { return &error[vertex * kHypotheses]; }
};

// The samples of a surface under a known light.
class LitSamples {
 public:
  // colors: #rows, SplitSystem::targets(). The rows must outlive the object.
  LitSamples(size_t vertices, const std::vector<SplitRow>& rows, std::vector<Vec3f> colors, BlurLadder&,
             const std::vector<Vec3f>& light);

  // max_diffuse: #V, diffuse radiance of a white dielectric: the upper bound of D.
  MaterialEvidence evidence(const std::vector<Vec3f>& max_diffuse) const;
  // D of the dielectrics under the light; `before` where there are no samples: #V.
  std::vector<Vec3f> fit_diffuse(const SplitMaterials&, std::vector<Vec3f> before) const;
  // Factor on the light that fits the dielectrics. positions: of the vertices, unit frame.
  LightScale light_scale(const SplitMaterials&, const std::vector<Vec3f>& positions) const;
  // For a light that plain least squares has determined: light_scale(), divided by the factor that plain
  // least squares of the same samples gives. It is the effect of giving less weight to changes along the
  // color of a surface.
  LightScale light_correction(const SplitMaterials&, const std::vector<Vec3f>& positions) const;

 private:
  template <class F>
  void for_dielectrics(const SplitMaterials&, const F& visit) const;  // visit(vertex, its samples)
  NoiseSums noise(const SplitMaterials&) const;
  LightScale light_scale(const SplitMaterials&, const std::vector<Vec3f>& positions,
                         const SampleNoise&) const;
  // What a row sees of the light if its surface has a given roughness.
  struct RowLight {
    ReflectedParts<float> reflected;
    Vec3f diffuse;  // factor from D to the diffuse radiance of the row
  };
  RowLight light_of(const SplitRow&, float roughness) const;
  int add_errors(uint32_t vertex, int level, Vec3f max_diffuse, float* errors) const;
  std::vector<ReflectionSample> of_dielectric(uint32_t vertex, const Material&) const;
  template <class F>
  int for_samples(uint32_t vertex, float roughness, const F& visit) const;

  const std::vector<SplitRow>& rows_;
  std::vector<Vec3f> colors_;
  int light_height_;
  Blurred sky_;
  LightDirectionMap light_directions_;
  // Rows by the vertex nearest to them: those of vertex v are order_[start_[v]] .. order_[start_[v + 1] - 1].
  std::vector<uint32_t> start_, order_;  // #V + 1; #rows
};

// The best dielectric and the best metal of a vertex. The roughness is interpolated between levels.
struct BestMaterials {
  float dielectric_roughness, metal_roughness;
  float dielectric_error, metal_error;
};
BestMaterials best_materials(const float* errors);

// The neighbors of every vertex, with weights in (0, 1] by how similar their colors are.
struct SimilarNeighbors {
  SimilarNeighbors(const Mesh&, const std::vector<Vec3f>& colors);  // colors: #V, linear
  VertexLists lists;
  std::vector<float> weight;  // #lists.items
};

// Replaces the sums of each vertex by sums over its surroundings of similar color: `steps` steps of diffusion
// between neighbors.
void diffuse_evidence(const SimilarNeighbors&, int steps, MaterialEvidence&);

// Probability of each vertex to be a metal: #V. What the samples of a vertex say (even odds at `even`, the
// ratio of the errors of metal and dielectric) is weighed against the vertices that a random walk from it
// over surface of similar color passes. So a patch that neither explains well takes the kind of material that
// surrounds it. steps: of the iteration that follows the walks; 0: each vertex for itself. [Grady 2006]
std::vector<float> metal_probability(const SimilarNeighbors&, const MaterialEvidence&, float even, int steps);

}  // namespace cei3d
