// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/sparse_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/base/thinned.h"
#include "core/math/quantile.h"
#include "core/math/rng.h"
#include "engine/capture/normalize.h"

namespace cei3d {
namespace {

// Lengths as shares of the radius that the photographs show.
constexpr double kReach = 1.5;  // maximum distance of the object from the center: it may fill the frame
constexpr double kBackgroundRadius = 2.5;  // points farther than this from the center are background
constexpr double kFlat = 0.02;             // maximum distance from a plane of points on it
constexpr double kAbove = 0.05;  // minimum distance from a plane of points clearly above or behind it
// Bounds of the distance up to which neighbors are points of one thing.
constexpr double kLinkMin = 0.04, kLinkMax = 0.15;
constexpr double kPlaneShare = 0.1;  // minimum share of the points in a plane that the object lies on
constexpr double kBehind = 0.03;     // maximum share of the points behind that plane, which are mistakes
constexpr int kPlaneTrials = 2000;
constexpr size_t kPlanePoints = 5000;  // maximum number of points that are counted

struct Plane {
  Vec3d normal;  // towards the cameras
  double offset = 0;
  double height(Vec3d p) const { return dot(normal, p) - offset; }
};

std::optional<Plane> plane_through(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d n = cross(b - a, c - a);
  const double size = length(n);
  if (!(size > 1e-12)) return std::nullopt;
  return Plane{n / size, dot(n / size, a)};
}

struct PlaneFit {
  Plane plane;
  size_t on = 0;
};

// The plane with most points on it that has none behind and all cameras before it. [Fischler and Bolles 1981]
std::optional<Plane> support_plane(const std::vector<Vec3d>& points, std::span<const View> views,
                                   double radius) {
  if (points.size() < 20) return std::nullopt;
  Rng rng(1, 0, 0);
  PlaneFit best;
  const auto any = [&] { return points[rng.below(uint32_t(points.size()))]; };
  for (int trial = 0; trial < kPlaneTrials; ++trial) {
    std::optional<Plane> p = plane_through(any(), any(), any());
    if (!p) continue;
    size_t before = 0, on = 0, behind = 0;
    for (const View& v : views) before += p->height(v.camera.center) > 0;
    if (before == 0) p->normal = -p->normal, p->offset = -p->offset, before = views.size();
    if (before != views.size()) continue;
    for (const Vec3d& x : points) {
      const double h = p->height(x) / radius;
      on += std::abs(h) < kFlat, behind += h < -kAbove;
    }
    if (double(behind) <= kBehind * double(points.size()) && on > best.on) best = {*p, on};
  }
  if (double(best.on) < kPlaneShare * double(points.size())) return std::nullopt;
  return best.plane;
}

using Cell = std::array<int, 3>;
Cell cell_of(Vec3d p, double size) {
  return {int(std::floor(p.x / size)), int(std::floor(p.y / size)), int(std::floor(p.z / size))};
}

// Groups of cells that touch each other, also at their corners; the index of the group of each point.
std::vector<int> groups_of(const std::vector<Vec3d>& points, double size) {
  std::map<Cell, int> group;
  for (const Vec3d& p : points) group[cell_of(p, size)] = -1;
  int groups = 0;
  for (auto& [start, of_start] : group) {
    if (of_start >= 0) continue;
    std::vector<Cell> open{start};
    of_start = groups;
    while (!open.empty()) {
      const Cell c = open.back();
      open.pop_back();
      for (int i = 0; i < 27; ++i) {
        const auto next = group.find({c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1});
        if (next == group.end() || next->second >= 0) continue;
        next->second = groups;
        open.push_back(next->first);
      }
    }
    ++groups;
  }
  std::vector<int> out;
  for (const Vec3d& p : points) out.push_back(group.at(cell_of(p, size)));
  return out;
}

// Half the size of what the photographs show at the center, the median of all.
double shown_radius(std::span<const View> views, Vec3d center) {
  std::vector<double> radii;
  for (const View& v : views) {
    const Camera& c = v.camera;
    radii.push_back(length(c.center - center) * std::min(c.width / c.fx, c.height / c.fy) / 2);
  }
  return median(radii);
}

Vec3d looked_at(std::span<const View> views) {
  std::vector<Vec3d> origins, axes;
  for (const View& v : views)
    origins.push_back(v.camera.center), axes.push_back(to_double(v.camera.forward()));
  const Vec3d center = nearest_point_to_lines(origins, axes);
  if (!std::isfinite(center.x + center.y + center.z))
    fail("All photographs look the same way; an object is photographed from all around.");
  return center;
}

// Distance up to which points belong to one thing: several times that of neighbors.
double link_of(const std::vector<Vec3d>& points, double radius) {
  constexpr size_t kAsked = 300, kCompared = 5000;
  constexpr double kNeighbors = 6;
  const std::vector<Vec3d> others = thinned(points, kCompared);
  std::vector<double> nearest;
  for (const Vec3d& p : thinned(points, kAsked)) {
    double best = kLinkMax * radius;
    for (const Vec3d& o : others)
      if (const double d = length(o - p); d > 0) best = std::min(best, d);
    nearest.push_back(best);
  }
  return nearest.empty() ? radius
                         : std::clamp(kNeighbors * median(nearest), kLinkMin * radius, kLinkMax * radius);
}

// 1 for the points of the group that has most of its points near the center.
std::vector<uint8_t> middle_group(const std::vector<Vec3d>& points, Vec3d center, double radius) {
  const std::vector<int> groups = groups_of(points, link_of(points, radius));
  std::map<int, double> weight;
  for (size_t i = 0; i < points.size(); ++i)
    weight[groups[i]] += std::exp(-4 * std::pow(length(points[i] - center) / radius, 2));
  int best = -1;
  for (const auto& [group, w] : weight)
    if (best < 0 || w > weight[best]) best = group;
  std::vector<uint8_t> out;
  for (const int g : groups) out.push_back(g == best);
  return out;
}

// At most kPlanePoints of those in the ball. Error: none.
std::vector<Vec3d> points_within(const std::vector<Vec3d>& points, Vec3d center, double radius) {
  std::vector<Vec3d> near;
  for (const Vec3d p : points)
    if (length(p - center) < radius) near.push_back(p);
  if (near.empty()) fail("No point was triangulated on what the photographs look at.");
  return thinned(near, kPlanePoints);
}

}  // namespace

SparsePoints sparse_points(std::span<const View> views) {
  SparsePoints out;
  std::map<std::array<double, 3>, uint32_t> index;
  for (const View& v : views) {
    out.views.emplace_back();
    if (!v.sightings) continue;
    for (const Sighting& s : *v.sightings) {
      const auto [at, added] =
          index.insert({{s.point.x, s.point.y, s.point.z}, uint32_t(out.positions.size())});
      if (added) out.positions.push_back(s.point);
      out.views.back().push_back({at->second, {float(s.pixel.x), float(s.pixel.y)}});
    }
  }
  return out;
}

PointSplit split_points(const SparsePoints& points, std::span<const View> views) {
  PointSplit out;
  out.center = looked_at(views);
  out.radius = shown_radius(views, out.center);
  const std::optional<Plane> plane =
      support_plane(points_within(points.positions, out.center, kReach * out.radius), views, out.radius);
  out.on_plane = plane.has_value();

  std::vector<uint32_t> above;
  std::vector<Vec3d> standing;
  for (uint32_t i = 0; i < points.positions.size(); ++i) {
    const Vec3d p = points.positions[i];
    const double height = plane ? plane->height(p) / out.radius : 1,
                 distance = length(p - out.center) / out.radius;
    const bool background = distance > kBackgroundRadius || height < kFlat;
    out.belief.push_back(background ? -1.0f : 0.0f);  // points close to the plane may be of either
    if (!background && distance < kReach && height > kAbove) above.push_back(i), standing.push_back(p);
  }
  const std::vector<uint8_t> is_object = middle_group(standing, out.center, out.radius);
  for (size_t i = 0; i < above.size(); ++i) out.belief[above[i]] = is_object[i] ? 1.0f : -0.5f;
  return out;
}

}  // namespace cei3d
