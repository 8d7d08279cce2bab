// SPDX-License-Identifier: Apache-2.0
// Subsets of a capture's views.
#pragma once

#include "model/scene/view.h"

namespace cei3d {

// Keeps `count` training views whose cameras are far from each other (greedily: the first view, then always
// the one farthest from those chosen), so that smaller subsets are contained in larger ones. The others
// become validation views: not trained on, but known by name, so that a scribble on one of them still has its
// view. count 0: keeps all. Usage errors: fewer than 2, or more than there are.
void keep_training_views(Capture& capture, int count);

// Makes a random share of the training views test views, at least one. The same seed chooses the same. Usage
// error: a share that leaves fewer than two to train on, or is not between 0 and 1.
void hold_out_random(Capture& capture, double share, uint64_t seed);

}  // namespace cei3d
