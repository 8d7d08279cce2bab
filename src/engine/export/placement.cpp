// SPDX-License-Identifier: Apache-2.0
#include "engine/export/placement.h"

#include <algorithm>
#include <cmath>

#include "core/math/axis_box.h"

namespace cei3d {

Vec3d Placement::turned(Vec3d v) const {
  const Vec3d q{rotation[0], rotation[1], rotation[2]};
  const double w = rotation[3];
  return v + cross(q, cross(q, v) + v * w) * 2.0;
}

bool Placement::operator==(const Placement& o) const {
  const Vec3d d = translation - o.translation;
  return rotation == o.rotation && scale == o.scale && dot(d, d) == 0;
}

Placement upright(Vec3d up) {
  const Vec3d u = normalize(up), axis = cross(u, Vec3d{0, 1, 0});
  const double w = 1 + u.y;
  if (w < 1e-9) return {{1, 0, 0, 0}, 1, {0, 0, 0}};  // upside down: half a turn about X
  const double n = 1 / std::sqrt(dot(axis, axis) + w * w);
  return {{axis.x * n, axis.y * n, axis.z * n, w * n}, 1, {0, 0, 0}};
}

Placement placement_of(std::span<const Vec3f> points, Vec3d up, const PlacementOptions& options) {
  Placement out = upright(up);
  AxisBoxOf<double> box;
  for (const Vec3f& p : points) box.add(out.turned(to_double(p)));
  const Vec3d size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  out.scale = options.size > 0 && longest > 0 ? options.size / longest : options.unit_scale;
  if (options.origin == Origin::base)
    out.translation = Vec3d{box.min.x + box.max.x, 2 * box.min.y, box.min.z + box.max.z} * (-0.5 * out.scale);
  return out;
}

}  // namespace cei3d
