// SPDX-License-Identifier: Apache-2.0
// The object as a mesh or point cloud for export, in the capture frame and unit.
#pragma once

#include "core/compute/device.h"
#include "engine/export/gltf.h"
#include "model/scene/scene.h"

namespace cei3d {

struct ColoredMesh {
  Mesh mesh;
  MeshMaterials materials;
  double error = 0;  // of the simplification, capture units
};

// The edited surface; vertex colors are linear albedo (glTF: base color). faces: at most; 0: all there are.
// Error: the scene has no surface.
ColoredMesh colored_mesh(const Device&, const Scene&, size_t faces = 0);

// The handler points and their normals, without triangles. Error: the scene has none.
Mesh handler_point_cloud(const Scene&);

}  // namespace cei3d
