// SPDX-License-Identifier: Apache-2.0
// Textures of the edited object for a mesh with fewer triangles: what the fields say at the surface point of
// every texel.
#pragma once

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "engine/export/textured_mesh.h"
#include "model/scene/scene.h"

namespace cei3d {

// Square images, row 0 at v = 0. Texels that no triangle covers have the values of those near them.
struct Textures {
  Image base_color;  // RGB, linear
  Image orm;         // R: share of the sky that is visible, G: roughness, B: metalness
  Image normal;      // RGB, tangent space, (n + 1) / 2
  Image specular;    // 1 channel, specular strength; empty where it is the same everywhere
  float middle_specular = 0.5f;
};

struct BakeOptions {
  int size = 2048;      // texels of a side
  float reach = 0.02f;  // how far the surface may be from the mesh, unit frame
};

// A texel's surface point is the nearest one along the mesh's normal, moved onto the zero set as for
// rendering. Texels that differ from a neighbor get four samples. mesh: in the unit frame.
Textures bake(const Device& device, const Scene& scene, const TexturedMesh& mesh, const BakeOptions& options,
              Progress& progress);

}  // namespace cei3d
