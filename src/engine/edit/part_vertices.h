// SPDX-License-Identifier: Apache-2.0
// Named parts on the vertices of the present surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace cei3d {

// #V, 1 where a vertex belongs to the part of that name; of several layers with one name the last counts.
// Usage error: no such part (the message lists the names).
std::vector<uint8_t> part_vertices(const Scene&, const std::string& part);

}  // namespace cei3d
