// SPDX-License-Identifier: Apache-2.0
// Light at the vertices of a surface, and the materials that bounces and reflections see there.
#pragma once

#include <span>
#include <vector>

#include "engine/render/transport.h"
#include "model/light/light_turns.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"

namespace cei3d {

// Materials of the vertices as seen in reflections and bounces.
struct VertexMaterials {
  std::vector<Vec3f> albedo;       // #V linear
  std::vector<Material> material;  // #V
  bool empty() const { return albedo.empty(); }
};

struct VertexLight {
  VertexMaterials made_of;
  std::vector<Vec3f> visibility;  // #V, share of the unoccluded sky irradiance that arrives, per channel
  std::vector<Vec3f> bounce;      // #V, irradiance from the surface itself
  std::vector<Vec3f> irradiance;  // #V, total
};

// Mean radiance of a light around each of sky_directions().
SkyRadiance sky_radiance(const SgMixture& light);

VertexLight vertex_light(const Transport&, const SgMixture&, VertexMaterials);

// vertex_light() for each bin of a turning light; turns null: for the light itself, one element. Only the
// first element has `made_of`.
std::vector<VertexLight> turned_vertex_lights(const Transport&, const SgMixture&, const VertexMaterials&,
                                              const LightTurns*);

// Update after a change of geometry. transport: of the changed surface, for its changed vertices. Only these
// are recomputed; the others keep their light, so that unchanged surface renders as before.
VertexLight vertex_light_after(VertexLight before, const Transport&, const SgMixture&, VertexMaterials);

}  // namespace cei3d
