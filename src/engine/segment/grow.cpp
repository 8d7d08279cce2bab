// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/grow.h"

#include <algorithm>

#include "core/base/error.h"
#include "engine/segment/random_walk.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

constexpr float kSeedReach = 2;  // spacings

// Paths from a click to the handler points around it.
class Clicks {
 public:
  explicit Clicks(const HandlerPoints& points)
      : points_(points), index_(points.positions, kSeedReach * points.spacing) {}

  std::vector<uint32_t> around(const SurfacePoint& click) const {
    std::vector<uint32_t> found;
    index_.any_within(click.position, kSeedReach * points_.spacing, [&](size_t i) {
      if (dot(points_.normals[i], click.normal) > 0) found.push_back(uint32_t(i));
      return false;
    });
    if (found.empty()) found.push_back(nearest(click));
    return found;
  }

  uint32_t nearest(const SurfacePoint& click) const {
    uint32_t best = 0;
    float least = 1e30f;
    for (uint32_t i = 0; i < points_.positions.size(); ++i) {
      const Vec3f d = points_.positions[i] - click.position;
      // Points on the other side count as far.
      const float distance = dot(d, d) + (dot(points_.normals[i], click.normal) > 0 ? 0 : 4);
      if (distance < least) least = distance, best = i;
    }
    return best;
  }

 private:
  const HandlerPoints& points_;
  PointIndex index_;
};

}  // namespace

std::vector<Seed> click_seeds(const HandlerPoints& points, std::span<const SurfacePoint> positive,
                              std::span<const SurfacePoint> negative) {
  std::vector<Seed> seeds(points.positions.size(), Seed::none);
  std::vector<uint8_t> both(seeds.size(), 0);
  const Clicks clicks(points);
  const auto put = [&](std::span<const SurfacePoint> list, Seed kind) {
    for (const SurfacePoint& click : list)
      for (const uint32_t i : clicks.around(click)) {
        both[i] |= seeds[i] != Seed::none && seeds[i] != kind;
        seeds[i] = kind;
      }
  };
  put(positive, Seed::positive);
  put(negative, Seed::negative);
  for (size_t i = 0; i < seeds.size(); ++i)
    if (both[i]) seeds[i] = Seed::none;
  const auto put_nearest = [&](std::span<const SurfacePoint> list, Seed kind) {
    for (const SurfacePoint& click : list) {
      Seed& seed = seeds[clicks.nearest(click)];
      if (seed != Seed::none && seed != kind)
        fail_usage(
            "A positive and a negative click meet the same point of the object; take one of them away.");
      seed = kind;
    }
  };
  put_nearest(positive, Seed::positive);
  put_nearest(negative, Seed::negative);
  return seeds;
}

std::vector<float> grow(const HandlerPoints& points, std::span<const Vec3f> albedo,
                        std::span<const Seed> seeds) {
  const PointGraph graph = point_graph(points, albedo);
  const std::vector<uint8_t> side = compete(graph, seeds);
  return random_walk(graph, seeds, std::vector<float>(side.begin(), side.end()));
}

}  // namespace cei3d
