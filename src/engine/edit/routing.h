// SPDX-License-Identifier: Apache-2.0
// The rule by which paint finds the surface that it covers. docs/method.md#regions-and-routing
#pragma once

namespace cei3d {

// Which points of the surface a painted edit changes.
enum class Routing {
  both,     // points within reach of edited handler points that the painted view sees inside the scribble
  points,   // points whose nearest handler point is edited, or those within a fixed distance, as in the paper
  outline,  // points that the painted view sees inside the scribble
  none      // all points: the object's albedo field is retrained on the scribble (relearn.h)
};

}  // namespace cei3d
