// SPDX-License-Identifier: Apache-2.0
// Where an exported object stands in the world of its file.
#pragma once

#include <array>
#include <span>

#include "core/math/vec.h"

namespace cei3d {

// How the object stands in the file's world, which is y-up: scale, turn, move, in this order.
struct Placement {
  std::array<double, 4> rotation{0, 0, 0, 1};  // quaternion x, y, z, w
  double scale = 1;                            // file units (meters) per capture unit
  Vec3d translation{0, 0, 0};

  Vec3d turned(Vec3d v) const;
  Vec3d operator()(Vec3d p) const { return turned(p) * scale + translation; }
  bool operator==(const Placement&) const;
};

// `up` (capture frame) becomes +Y, by the shortest turn.
Placement upright(Vec3d up);

enum class Origin {
  input,  // that of the capture
  base,   // the middle of the underside of the object's box
};

struct PlacementOptions {
  Origin origin = Origin::input;
  double unit_scale = 1;  // meters per capture unit
  double size = 0;        // meters of the longest side of the object's box, instead of unit_scale; 0: no wish
};
// points: of the object, capture frame, at least one.
Placement placement_of(std::span<const Vec3f> points, Vec3d up, const PlacementOptions& options);

}  // namespace cei3d
