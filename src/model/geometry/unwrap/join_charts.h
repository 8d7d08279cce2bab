// SPDX-License-Identifier: Apache-2.0
// Flat charts joined to larger ones.
#pragma once

#include <vector>

#include "model/geometry/unwrap/flatten.h"

namespace cei3d {

// Joins charts, the smallest first, to that neighbor with which they share most of their border, where the
// union can be laid flat with little stretch, or no more than that of its parts. Charts that share a small
// part of their borders stay apart: their union is long and thin or has arms, and is packed badly. charts:
// all that cover the graph's faces.
std::vector<FlatChart> joined(const FaceGraph& graph, const Flattener& flattener,
                              std::vector<FlatChart> charts);

}  // namespace cei3d
