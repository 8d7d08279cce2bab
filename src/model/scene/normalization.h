// SPDX-License-Identifier: Apache-2.0
// Similarity transform between the capture frame and the unit frame, in which fields live.
#pragma once

#include "core/math/camera.h"

namespace cei3d {

struct Normalization {
  Vec3d center{0, 0, 0};  // capture frame
  double scale = 1;       // unit-frame lengths per length of the capture frame

  Vec3d unit_from_capture(Vec3d p) const { return (p - center) * scale; }
  Vec3d capture_from_unit(Vec3d p) const { return p / scale + center; }
  Camera unit_from_capture(Camera c) const {
    c.center = unit_from_capture(c.center);
    return c;
  }
};

}  // namespace cei3d
