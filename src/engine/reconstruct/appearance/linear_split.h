// SPDX-License-Identifier: Apache-2.0
// Linear separation of light and albedo. A pixel is D(x) k_d + S(x, v; roughness) L, with k_d known
// (diffuse_view()). The diffuse radiance D is free for every surface point, so the light L is determined only
// by how a point changes with the view, which albedo does not affect. For a given roughness D and L are
// linear unknowns. Albedo follows as D over the irradiance of L. Metals have no D; for them light and
// reflectance alternate. Where several materials explain the images better than one, each vertex has its own.
// (docs/method.md#appearance-stage)
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

// Observations of the surface: hits of training pixels and their colors.
struct SurfaceSamples {
  std::span<const Hit> hits;      // #N, unit frame
  std::span<const Vec3f> colors;  // #N linear radiance
  // #N, bit c: channel c is clipped, its color is a lower bound of the radiance; empty: none is.
  std::span<const uint8_t> clipped;
  // #N, pixel footprints, see pixel_points(); empty: colors are of points.
  std::span<const float> footprints = {};
  TurnedHits turned = {};  // #N
  bool is_clipped(size_t sample, int channel) const {
    return !clipped.empty() && (clipped[sample] >> channel & 1);
  }
};

struct LinearSplitOptions {
  int max_hits = 600000;  // maximum number of samples of the final solve; beyond it a random subset
  // Whether that subset is of patches of the surface with all of their samples. Only vertices with several
  // samples say something of the light, so that this needs fewer; but the rest of the surface has none.
  bool in_patches = false;
  int light_height = 48;       // rows of the light's lat-long grid, EnvUp::z
  int rounds = 4;              // of conjugate gradients; negative light is clamped and frozen between rounds
  int steps = 12;              // of conjugate gradients per round
  int search_hits = 200000;    // maximum number of samples while one material is searched
  int material_hits = 600000;  // maximum number of samples while materials of the vertices are searched
  int search_height = 32;      // rows of the light in both searches
  float scan_step = 1.4f;      // factor between the roughnesses of the scan
  int refinements = 1;         // halvings of that step, about the best roughness of the scan
  float fixed_roughness = 0;   // > 0: known, not searched
  bool several_expected = false;  // the object was already found to have several materials
  LightColorPrior light_color;
  // Weight of the light's smoothness, relative to the mean curvature of its unknowns.
  float smoothness = 1e-4f;
  uint64_t seed = 1;
  // Every n-th view does not take part, and residuals are of those views alone; 0: all take part. Needs
  // SurfaceSamples::turned.views.
  int hold_out = 0;
};

struct LinearSplit {
  Material material;                // mean over the surface
  std::vector<Material> materials;  // #V, metalness 0 or 1; empty: `material` everywhere
  float smoothest = 0;              // roughness of the smoothest hundredth of the surface
  // Covariance of the light; 0 where its strength is unknown: all is metal, or the light was scaled up to
  // keep the albedo at most 1.
  LightCovariance light_error{};
  Image light;                 // light_height rows, 2 light_height columns, RGB, linear, >= 0
  std::vector<Vec3f> albedo;   // #V, linear, [0, 1]
  std::vector<Vec3f> diffuse;  // #V, view-independent radiance D, linear; zero for metals
  struct Trial {
    bool metal;
    float roughness;
    double residual;  // mean squared error in display units
  };
  std::vector<Trial> trials;  // of one material, in the order of the search
};

LinearSplit linear_split(const Transport&, const SurfaceSamples&, const LinearSplitOptions&, Progress&);

// Whether several materials are chosen. one, several: residuals of one material and of several, see
// LinearSplit::Trial.
bool several_explain_more(double one, double several, bool expected);

// How well views that are held out (options.hold_out) are explained by one dielectric of that roughness, or,
// beginning with it, by a material per vertex: LinearSplit::Trial::residual of each of those views that has
// samples, in their order.
std::vector<double> held_out_residuals(const Transport&, const SurfaceSamples&, const LinearSplitOptions&,
                                       float roughness, bool several_materials, Progress&);

}  // namespace cei3d
