// SPDX-License-Identifier: Apache-2.0
// Light and material told apart by one linear solve. A pixel is D(x) d(v; roughness) + S(x, v; roughness) L,
// with d known (diffuse_view()): whatever of it does not change with the view stays in D, free for every
// surface point, so the light L can only be read from how a point changes with the view, where albedo cannot
// interfere. For a given roughness both are linear unknowns. Albedo then is D over the irradiance of L:
// explicit. Metals have no D; there light and reflectance alternate. Where several materials explain the
// pictures better than one, each vertex has its own.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "engine/render/transport.h"
#include "model/light/light_color.h"
#include "model/light/light_turns.h"
#include "model/material/material.h"

namespace cei3d {

// What the cameras saw of the surface.
struct SurfaceSamples {
  std::span<const Hit> hits;      // #N, unit-sphere frame
  std::span<const Vec3f> colors;  // #N linear radiance
  // #N, bit c: channel c is as bright as pictures get, and the radiance at least that; empty: no channel is.
  std::span<const uint8_t> clipped;
  std::span<const float> footprints = {};  // #N, of pixels (pixel_points()); empty: colors of points
  TurnedHits turned = {};                  // #N
  bool is_clipped(size_t sample, int channel) const {
    return !clipped.empty() && (clipped[sample] >> channel & 1);
  }
};

struct LinearSplitOptions {
  int most_hits = 600000;      // a random subset of the samples beyond that
  int light_height = 48;       // rows of the light's lat-long grid, EnvUp::z
  int rounds = 4, steps = 12;  // of conjugate gradients; negative light is clamped and frozen between rounds
  int search_hits = 200000;    // samples, and
  int material_hits = 600000;  // samples while materials of the vertices are searched
  int search_height = 32;      // rows of the light, in both searches
  float scan_step = 1.4f;      // from one roughness to the next, and
  int refinements = 3;         // bisections afterwards
  float fixed_roughness = 0;   // > 0: no search
  LightColorPrior light_color;
  float smoothness = 1e-4f;  // of the light, relative to the mean curvature of its unknowns
  float tolerance = 0.008f;  // the largest roughness whose residual is within this of the best is taken
  uint64_t seed = 1;
};

struct LinearSplit {
  Material material;                // mean over the surface
  std::vector<Material> materials;  // #V, metalness 0 or 1; empty: `material` everywhere
  float smoothest = 0;              // roughness of the smoothest hundredth of the surface
  LightCovariance
      light_error{};           // of the light; of metals alone none is known, their light is taken for gray
  Image light;                 // light_height rows, 2 light_height columns, RGB, linear, >= 0
  std::vector<Vec3f> albedo;   // #V base color, linear, [0, 1]
  std::vector<Vec3f> diffuse;  // #V view-independent radiance D; zero for metals
  struct Trial {
    bool metal;
    float roughness;
    double residual;  // mean squared error in display units
  };
  std::vector<Trial> trials;  // in the order they were run
};

LinearSplit linear_split(const Transport&, const SurfaceSamples&, const LinearSplitOptions&, Progress&);

// What a dielectric of that roughness leaves, as LinearSplit::Trial::residual.
double dielectric_residual(const Transport&, const SurfaceSamples&, const LinearSplitOptions&,
                           float roughness, Progress&);

}  // namespace cei3d
