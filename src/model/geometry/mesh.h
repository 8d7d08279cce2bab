// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct Mesh {
  std::vector<Vec3f> positions;                    // #V
  std::vector<Vec3f> normals;                      // #V unit, outward; may be empty
  std::vector<Vec3f> colors;                       // #V linear; may be empty
  std::vector<std::array<uint32_t, 3>> triangles;  // #F, counter-clockwise seen from outside
};

}  // namespace cei3d
