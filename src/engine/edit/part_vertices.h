// SPDX-License-Identifier: Apache-2.0
// The parts that edits have named, on the vertices of the present surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace cei3d {

// #V, 1 where a vertex of the scene's surface belongs to the part of that name; of several layers with one
// name the last counts. Usage error: there is no such part (those there are are named).
std::vector<uint8_t> part_vertices(const Scene&, const std::string& part);

}  // namespace cei3d
