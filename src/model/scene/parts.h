// SPDX-License-Identifier: Apache-2.0
// Named parts of the object.
#pragma once

#include <string>
#include <vector>

#include "model/scene/scene.h"

namespace cei3d {

// The last layer that defines the part of that name; its region refers to the layer's shape version. Usage
// error: no such part (the message lists the names).
const EditLayer& part_layer(const Scene&, const std::string& part);

std::vector<std::string> part_names(const Scene&);  // sorted

// The part that each hit of the present surface is in. Where parts overlap, the one that was made later
// counts.
struct PartsOfHits {
  std::vector<std::string> names{""};  // at most 256; the first stands for no part
  std::vector<uint8_t> of;             // #hits, index in `names`
};
PartsOfHits parts_of(const Scene&, std::span<const Hit> hits);

// #hits, 1 where a hit of the present surface is in the layer's region; surface that was added later gets 0.
std::vector<uint8_t> inside_layer(const Scene&, const EditLayer&, std::span<const Hit> hits);

}  // namespace cei3d
