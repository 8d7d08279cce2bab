// SPDX-License-Identifier: Apache-2.0
// Solutions of the linear split for one size of the problem: for one material, and for a material at every
// vertex.
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

// A solution for a problem of any size.
struct SplitGuess {
  std::vector<Vec3f> diffuse;  // #V
  Image light;                 // empty: no guess
};

class SplitSolver {
 public:
  // Conjugate gradients are slow to find the strength of the light where dielectrics reflect it: solutions
  // with dielectrics start from the last one, the first from `guess`; without a guess from uniform light.
  SplitSolver(const Transport&, const SurfaceSamples&, const LinearSplitOptions&, Progress&,
              SplitGuess guess = {});

  SplitSolver(const SplitSolver&) = delete;  // the system refers to the rows

  size_t rows() const { return rows_.size(); }
  const SplitGuess& last() const { return guess_; }
  SplitSolution dielectric(float roughness);
  SplitSolution metal(float roughness);
  // Finds the materials of the vertices: by turns the materials that explain the samples best under the
  // light, and the light for these materials. start: the light to begin with. max_residual: gives up, with
  // the residual as it is, when the first turn leaves more.
  SplitSolution several(SplitSolution start, double max_residual);
  // The light for these materials.
  SplitSolution with_materials(const SplitMaterials&);
  // What the samples say of its strength.
  LightScale light_scale(const SplitSolution&);
  // Times the light, metals darker by as much, dielectrics as the samples then want them.
  void scale_light(SplitSolution&, Vec3f factor);

  std::vector<LinearSplit::Trial> trials;  // of one material

 private:
  SplitUnknowns uniform() const;  // light; each vertex the mean color of its samples
  SplitUnknowns guessed() const;
  SplitSolution guess(SplitMaterials);
  void turn_diffuse_light(const SplitSolution&);
  void remember(const SplitUnknowns&);
  SplitSolution solved(SplitSolution, int rounds, int steps);
  SplitSolution with_fitted_metals(SplitSolution, int rounds, int steps);
  SplitSolution finish(SplitSolution, bool metal, float roughness);
  LitSamples lit_samples(const SplitUnknowns&);
  void choose_materials(const SplitUnknowns&, float max_albedo, SplitMaterials&);
  void fix_scale(SplitSolution&);
  std::vector<Vec3f> white_radiance(const SplitSolution&, float albedo) const;

  const Transport& transport_;
  const Mesh& mesh_;
  const LightTurns* turns_;
  std::vector<SplitRow> rows_;
  LinearSplitOptions options_;
  Progress& progress_;
  SplitSystem system_;
  std::unique_ptr<TurningIrradiance> turning_;  // null: the light stands still
  SplitGuess guess_;
};

}  // namespace cei3d
