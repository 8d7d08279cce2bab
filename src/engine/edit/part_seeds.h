// SPDX-License-Identifier: Apache-2.0
// What a user shows of a part in one view, as seeds on the handler points.
#pragma once

#include "engine/edit/part.h"
#include "engine/segment/compete.h"

namespace cei3d {

// #handlers, from the request's mask or else its clicks. Errors: see select_part().
std::vector<Seed> part_seeds(const Device&, const Scene&, const PartRequest&);

}  // namespace cei3d
