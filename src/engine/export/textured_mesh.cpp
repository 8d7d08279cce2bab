// SPDX-License-Identifier: Apache-2.0
#include "engine/export/textured_mesh.h"

#include "engine/export/tangents.h"

namespace cei3d {

TexturedMesh textured_mesh(const Mesh& mesh, const Atlas& atlas) {
  TexturedMesh out;
  for (const uint32_t v : atlas.vertex) {
    out.positions.push_back(mesh.positions[v]);
    out.normals.push_back(normalize(mesh.normals[v]));
  }
  out.uv = atlas.uv;
  out.triangles = atlas.triangles;
  out.tangents = tangents_of(out.positions, out.normals, out.uv, out.triangles);
  return out;
}

}  // namespace cei3d
