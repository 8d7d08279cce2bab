// SPDX-License-Identifier: Apache-2.0
// Solver of the linear separation for given samples and light resolution: with one material, or with a
// material per vertex.
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/appearance/material_evidence.h"
#include "engine/reconstruct/appearance/split_irradiance.h"

namespace cei3d {

struct SplitSolution {
  SplitUnknowns x;
  SplitMaterials materials;
  double residual = 0;
};

// A solution to start from, of any light resolution.
struct SplitGuess {
  std::vector<Vec3f> diffuse;  // #V
  Image light;                 // empty: no guess
};

class SplitSolver {
 public:
  // Conjugate gradients converge slowly in the strength of the light for dielectrics. Therefore solutions
  // with dielectrics start from the last one, the first from `guess`, and without a guess from uniform light.
  SplitSolver(const Transport&, const SurfaceSamples&, const LinearSplitOptions&, Progress&,
              SplitGuess guess = {});

  SplitSolver(const SplitSolver&) = delete;  // the system refers to the rows

  size_t rows() const { return rows_.size(); }
  const SplitGuess& last() const { return guess_; }
  SplitSolution dielectric(float roughness);
  SplitSolution metal(float roughness);
  std::vector<SplitSystem::ViewError> errors_of_views(const SplitSolution& s) const {
    return system_.errors_of_views(s.x);
  }
  // Materials per vertex: alternates between the best materials under the light and the light for these
  // materials. start: initial light. max_residual: stops after a round that leaves a larger residual.
  SplitSolution several(SplitSolution start, double max_residual);
  // Light and D for given materials.
  SplitSolution with_materials(const SplitMaterials&);
  // D and the specular strength, at most the usual one, of one dielectric under a given light: #cells.
  SplitSolution under_light(const std::vector<Vec3f>& light, float roughness);
  // A factor on the light of the solution, estimated from the samples (LitSamples::light_correction()).
  LightScale light_correction(const SplitSolution&);
  // Multiplies the light by `factor`, divides the color of metals by it, and refits the dielectrics.
  void scale_light(SplitSolution&, Vec3f factor);

  std::vector<LinearSplit::Trial> trials;  // of one material

 private:
  SplitUnknowns uniform() const;  // uniform light; D of each vertex: the mean color of its samples
  SplitUnknowns guessed() const;
  SplitSolution guess(SplitMaterials);
  void turn_diffuse_light(const SplitSolution&);
  void remember(const SplitUnknowns&);
  SplitSolution solved(SplitSolution, int rounds, int steps);
  SplitSolution with_fitted_metals(SplitSolution, int rounds, int steps);
  SplitSolution finish(SplitSolution, bool metal, float roughness);
  LitSamples lit_samples(const SplitUnknowns&);
  // settled: the scale of the light is known well enough. extended: by which the change of a roughness is
  // multiplied, over its logarithm.
  void choose_materials(const SplitUnknowns&, const SimilarNeighbors&, bool settled, float extended,
                        SplitMaterials&);
  void fix_scale(SplitSolution&);
  // Of vertices at rows. Under a turning light the solution must be the one turned last.
  std::vector<Vec3f> white_radiance(const SplitSolution&, float albedo) const;

  const Transport& transport_;
  const Mesh& mesh_;
  std::vector<Vec3f> colors_;  // #V, mean_colors()
  std::vector<SplitRow> rows_;
  LinearSplitOptions options_;
  Progress& progress_;
  SplitSystem system_;
  // #V, 1 for the corners of rows and of their far points; empty: rows are all over the surface.
  std::vector<uint8_t> at_rows_;
  std::unique_ptr<TurningIrradiance> turning_;  // null: the light stands still
  std::vector<Vec3f> irradiance_;               // under a turning light, of the solution turned last
  SplitGuess guess_;
};

}  // namespace cei3d
