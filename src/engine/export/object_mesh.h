// SPDX-License-Identifier: Apache-2.0
// The object as a mesh or point cloud for export, in the capture frame and unit.
#pragma once

#include "core/compute/device.h"
#include "engine/export/gltf.h"
#include "model/scene/parts.h"

namespace cei3d {

struct ColoredMesh {
  Mesh mesh;
  MeshMaterials materials;
  double error = 0;  // of the simplification, capture units
};

// The edited surface; vertex colors are linear albedo (glTF: base color). faces: at most; 0: all there are.
// Errors: the scene has no surface, or an empty one.
ColoredMesh colored_mesh(const Device&, const Scene&, size_t faces = 0);

// The handler points with all that is known of them. Error: the scene has none.
struct HandlerCloud {
  Mesh points;                    // positions, normals and linear albedo; no triangles
  std::vector<float> footprints;  // #points, capture units
  PartsOfHits parts;
};
HandlerCloud handler_cloud(const Device&, const Scene&);

// As PLY: comments "part 1 lid" name the values of the property "part", 0 is none.
std::string encode_handlers(const HandlerCloud&);

}  // namespace cei3d
