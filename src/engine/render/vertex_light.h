// SPDX-License-Identifier: Apache-2.0
// The light that reaches the vertices of a surface, and what the surface looks like there in reflections of
// itself.
#pragma once

#include <span>
#include <vector>

#include "engine/render/transport.h"
#include "model/light/light_turns.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"

namespace cei3d {

// What the surface is made of at its vertices, as far as reflections and bounces see it.
struct VertexMaterials {
  std::vector<Vec3f> albedo;       // #V linear
  std::vector<Material> material;  // #V
  bool empty() const { return albedo.empty(); }
};

struct VertexLight {
  VertexMaterials made_of;
  std::vector<Vec3f>
      visibility;  // #V fraction of the environment's unoccluded irradiance that arrives, per channel
  std::vector<Vec3f> bounce;      // #V irradiance from the surface itself
  std::vector<Vec3f> irradiance;  // #V of both together
};

// Mean radiance of a light around each of sky_directions().
SkyRadiance sky_radiance(const SgMixture& light);

VertexLight vertex_light(const Transport&, const SgMixture&, VertexMaterials);

// Of each bin of the light's turns; null: of the light as it is. Only the first knows the materials.
std::vector<VertexLight> turned_vertex_lights(const Transport&, const SgMixture&, const VertexMaterials&,
                                              const LightTurns*);

// After a change of geometry. transport: of the changed surface, for its changed vertices. Only those are lit
// anew: the others keep their light, so that what did not change looks as before.
VertexLight vertex_light_after(VertexLight before, const Transport&, const SgMixture&, VertexMaterials);

}  // namespace cei3d
