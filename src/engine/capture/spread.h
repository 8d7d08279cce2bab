// SPDX-License-Identifier: Apache-2.0
// Subsets of a capture's views.
#pragma once

#include "model/scene/view.h"

namespace cei3d {

// Keeps `count` training views whose cameras are far from each other (greedily: the first view, then always
// the one farthest from all chosen); smaller subsets are contained in larger ones. The others become
// validation views: they are not trained on, but keep their names, so that a scribble on one of them still
// has its view. 0: keeps all. Usage errors: fewer than 2, or more than there are.
void keep_training_views(Capture& capture, int count);

}  // namespace cei3d
