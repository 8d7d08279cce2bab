// SPDX-License-Identifier: Apache-2.0
// Fewer views of a capture, for trials of how many are needed.
#pragma once

#include "model/scene/view.h"

namespace cei3d {

// Keeps `count` training views whose cameras stand as far from each other as can be (greedily: the first
// view, then always the one that is farthest from all chosen); fewer are always among more. The others become
// validation views: they are not trained on, but keep their names, so that a scribble made on one of them
// still has its view. 0: keeps all. Usage errors: fewer than 2, or more than there are.
void keep_training_views(Capture& capture, int count);

}  // namespace cei3d
