// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// Which points of the surface a painted edit changes.
enum class Routing {
  both,     // those within reach of edited handler points that the painted view sees in the scribble
  points,   // those within reach of edited handler points, as in the paper: the outline is as soft as their
            // reach
  outline,  // those that the painted view sees in the scribble
  none      // all: the object's one color field learns the scribble (relearn.h)
};

}  // namespace cei3d
