// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/point_distance.h"

#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace cei3d {
namespace {

constexpr int kLevels = 5;
// Radius of the searches of a level and spacing of the next coarser one, in spacings of the level.
constexpr float kSpacings = 4;
// Distances, in spacings, up to which the surface is taken as the plane of the nearest point, and from which
// on the distance is that to the point itself. Between them both are blended.
constexpr float kFlat = 1, kRound = 3;

HandlerPoints thinned(const HandlerPoints& points, float spacing) {
  std::vector<Hit> hits;
  for (size_t i = 0; i < points.positions.size(); ++i)
    hits.push_back({points.positions[i], points.normals[i], points.normals[i], 0, 0, 0});
  return thin_hits(hits, points.footprints, spacing);
}

constexpr float kFarAway = 4;  // distance of what is far outside the unit sphere

float length_1(Vec3f v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

PointDistance::PointDistance(HandlerPoints points) {
  if (points.positions.empty()) fail("A surface without points has no distance (an error in the program).");
  for (int k = 0; k < kLevels; ++k) {
    const float spacing = points.spacing, radius = kSpacings * spacing;
    PointIndex index(points.positions, radius);
    HandlerPoints coarser = k + 1 < kLevels ? thinned(points, radius) : HandlerPoints();
    levels_.push_back({std::move(points), radius, std::move(index)});
    points = std::move(coarser);
    points.spacing = radius;
  }
}

// The finest level that has a point within its radius gives the nearest one of its points, since no norm used
// here is below the Euclidean one. Finer points around that one come nearer.
template <class Norm>
float PointDistance::nearest(Vec3f x, const Norm& norm, size_t& point) const {
  float smallest = std::numeric_limits<float>::infinity();
  const auto search = [&](const Level& l, Vec3f center) {
    l.index.any_within(center, l.radius, [&](size_t i) {
      const float d = norm(x - l.points.positions[i]);
      if (d < smallest || (d == smallest && i < point)) smallest = d, point = i;
      return false;
    });
  };
  size_t level = 0;
  for (; level < levels_.size() && !(smallest <= levels_[level].radius); ++level) search(levels_[level], x);
  for (size_t k = level; k > 1 && std::isfinite(smallest); --k) {
    const Vec3f from = levels_[k - 1].points.positions[point];
    smallest = std::numeric_limits<float>::infinity();
    search(levels_[k - 2], from);
  }
  return smallest;
}

float PointDistance::l1_distance(Vec3f x) const {
  size_t point = 0;
  return min(nearest(x, length_1, point), kFarAway);
}

float PointDistance::signed_distance(Vec3f x) const {
  size_t point = 0;
  const float d = nearest(
      x, [](Vec3f v) { return length(v); }, point);
  if (!(d < kFarAway)) return kFarAway;
  const HandlerPoints& points = levels_.front().points;
  const float along = dot(x - points.positions[point], points.normals[point]);
  const float t = clamp((d / points.spacing - kFlat) / (kRound - kFlat), 0.0f, 1.0f);
  return std::copysign(std::abs(along) * (1 - t) + d * t, along);
}

}  // namespace cei3d
