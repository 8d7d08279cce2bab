// SPDX-License-Identifier: Apache-2.0
// What reaches the vertices of a surface: how much of the sky's light, what the surface itself adds by one
// bounce, and what it therefore sends out to whoever sees it in a reflection.
#pragma once

#include <span>
#include <vector>

#include "engine/render/transport.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

struct VertexLight {
  std::vector<Vec3f> base_color;  // #V linear
  std::vector<Vec3f> openness;    // #V share of the open sky's irradiance that arrives, per channel
  std::vector<Vec3f> bounce;      // #V irradiance from the surface itself
  std::vector<Vec3f>
      arriving;  // #V irradiance of both over pi: times the base colour, what a diffuse surface sends out
};

// Mean radiance of a light around each of sky_directions().
SkyRadiance sky_radiance(const SgMixture& light);

// base_color: #V, linear.
VertexLight vertex_light(const Transport&, const SgMixture&, std::span<const Vec3f> base_color);

// After a change of geometry. transport: of the changed surface, for its changed vertices. Those alone are
// lit anew: the others keep what they had, so that what did not change looks as before.
VertexLight vertex_light_after(VertexLight before, const Transport&, const SgMixture&,
                               std::span<const Vec3f> base_color);

}  // namespace cei3d
