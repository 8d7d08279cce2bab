// SPDX-License-Identifier: Apache-2.0
// Parts: regions that edits have named.
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace cei3d {

// The layer that says where the part of that name is: the last one that does. Its region lives in its pose.
// Usage error: there is none (the names that there are are listed).
const EditLayer& part_layer(const Scene&, const std::string& part);

std::vector<std::string> part_names(const Scene&);  // sorted

// #hits, 1 where a hit of the present surface belongs to the layer; matter made after the layer does not.
std::vector<uint8_t> inside_layer(const Scene&, const EditLayer&, std::span<const Hit> hits);

}  // namespace cei3d
