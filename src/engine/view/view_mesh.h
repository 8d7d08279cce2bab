// SPDX-License-Identifier: Apache-2.0
// The object as graphics hardware draws it: arrays by vertex from which src/web/renderer.js makes the
// program's own picture. They are packs (engine/view/pack.h) that depend on different things, so that a page
// that is open gets anew only what has changed. Capture frame and unit throughout.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/compute/device.h"
#include "engine/render/vertex_light.h"
#include "model/scene/appearance.h"
#include "model/scene/scene.h"

namespace cei3d {

// Triangles between some vertices of the scene's present surface.
struct ViewMesh {
  std::vector<uint32_t> vertices;                  // #V, ids in the surface's mesh
  std::vector<std::array<uint32_t, 3>> triangles;  // #F, positions in `vertices`
  double error = 0;                                // of the simplification, capture units
};

// faces: at most; 0: all. Error: the scene has no surface.
ViewMesh view_mesh(const Scene&, size_t faces = 0);

// "shape": positions u16 [#V, 4] in the box of the head (min, size; the last column is 0), normals i16 [#V,
// 2] on the octahedron, visibility i8 [#V, 12] of visibility_harmonics() in units of the head's
// visibility_scale, triangles u32 [#F, 3].
std::string view_shape(const Scene&, const ViewMesh&);

// "coarse": triangles u32 [#F, 3], positions in the view's vertices, 30,000 at most: for pictures that must
// be drawn quickly.
std::string view_coarse(const Scene&, const ViewMesh&);

// "look": albedo u16 [#V, 4], the square roots of linear RGB, and the share that is shown without light;
// material u8 [#V, 4]: roughness, specular, metalness in 255ths, and the part, an index in the head's list of
// part names, 0 for none. Where parts overlap the later one counts.
std::string view_look(const Device&, const Scene&, const ViewMesh&);
// look: appearance_at() of vertex_hits() of the present surface.
std::string view_look(const Scene&, const ViewMesh&, const Appearance& look);

// "vertex_light": visibility u8 [#V, 4], VertexLight::visibility in 255ths; bounce u32 [#V, 1],
// VertexLight::bounce with a shared exponent. light: at the vertices of the present surface,
// SceneLight::vertices().
std::string view_vertex_light(const VertexLight& light, const ViewMesh&);

}  // namespace cei3d
