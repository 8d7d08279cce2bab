// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/coverage.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

constexpr int kDirections = 4096;  // 3 degrees apart
constexpr double kUnseen = 50;     // degrees to the nearest camera: a quarter of the way around is missing
constexpr size_t kMinViews = 10;   // minimum number of views; below it check() already reports too few views
// Sides: directions up to 45 degrees above the horizontal.
constexpr double kHighest = 0.7071;

double degrees(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / kPi; }

struct Facing {
  Vec3d direction;  // from the object, unit
  const View* view;
};

std::vector<Facing> facing_cameras(const Capture& capture, Vec3d center) {
  std::vector<Facing> all;
  for (const View& v : capture.views) {
    const Vec3d d = v.camera.center - center;
    if (v.split == Split::train && std::isfinite(dot(d, d)) && dot(d, d) > 0)
      all.push_back({normalize(d), &v});
  }
  return all;
}

std::vector<Vec3d> directions_of(const std::vector<Facing>& cameras) {
  std::vector<Vec3d> all;
  for (const Facing& c : cameras) all.push_back(c.direction);
  return all;
}

// Of the cameras on the two sides of a gap, those nearest to its middle.
std::pair<const View*, const View*> beside(const std::vector<Facing>& cameras, Vec3d middle, Vec3d up) {
  const Vec3d across = cross(up, middle);
  const auto nearest = [&](double side) {
    const Facing* best = nullptr;
    for (const Facing& c : cameras)
      if (side * dot(c.direction, across) >= 0 &&
          (!best || dot(c.direction, middle) > dot(best->direction, middle)))
        best = &c;
    return best ? best->view : nullptr;
  };
  return {nearest(-1), nearest(1)};
}

std::string between_text(const std::vector<Facing>& cameras, Vec3d middle, Vec3d up) {
  const auto [a, b] = beside(cameras, middle, up);
  if (a && b && a != b) return fmt::format(" between {} and {}", a->name, b->name);
  return fmt::format(" beside {}", (a ? a : b)->name);
}

}  // namespace

SeenSides seen_sides(std::span<const Vec3d> cameras, const std::function<bool(Vec3d)>& wanted) {
  SeenSides out;
  int all = 0, seen = 0;
  double min_cosine = 2;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3d d = to_double(fibonacci_direction(i, kDirections));
    if (wanted && !wanted(d)) continue;
    double cosine = -1;
    for (const Vec3d& c : cameras) cosine = std::max(cosine, dot(c, d));
    ++all;
    seen += degrees(cosine) <= kSeenWithin;
    if (cosine < min_cosine) min_cosine = cosine, out.unseen = d;
  }
  out.share = double(seen) / std::max(all, 1);
  out.gap = all > 0 ? degrees(min_cosine) : 0;
  return out;
}

SeenSides seen_sides(const Capture& capture, Vec3d center) {
  return seen_sides(directions_of(facing_cameras(capture, center)));
}

void check_coverage(const Capture& capture, Vec3d center, std::vector<Finding>& findings) {
  const std::vector<Facing> cameras = facing_cameras(capture, center);
  if (cameras.size() < kMinViews) return;
  const Vec3d up = normalize(capture.up);
  const SeenSides sides =
      seen_sides(directions_of(cameras), [&](Vec3d d) { return dot(d, up) >= 0 && dot(d, up) <= kHighest; });
  if (sides.gap <= kUnseen) return;
  if (sides.share < 0.5)
    findings.push_back(
        {Severity::note,
         fmt::format("The photographs show one side of the object: only {:.0f} % of its sides are within {} "
                     "degrees of a camera.",
                     100 * sides.share, kSeenWithin),
         "The rest will be guessed. Photographs from all around make a whole object."});
  else
    findings.push_back(
        {Severity::warning,
         fmt::format("A side of the object is not photographed: for {:.0f} degrees around the direction "
                     "({:.2g}, {:.2g}, {:.2g}) there is no camera{}.",
                     sides.gap, sides.unseen.x, sides.unseen.y, sides.unseen.z,
                     between_text(cameras, sides.unseen, up)),
         "Take photographs from there, 10 to 15 degrees apart; else that side is guessed."});
}

}  // namespace cei3d
