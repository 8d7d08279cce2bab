// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/grow.h"

#include <algorithm>

#include "core/base/error.h"
#include "engine/segment/random_walk.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

constexpr float kClickReach = 2, kStrokeReach = 1;  // spacings

// Paths from a click to the handler points around it.
class Clicks {
 public:
  Clicks(const HandlerPoints& points, float reach)
      : points_(points), reach_(reach * points.spacing), index_(points.positions, reach_) {}

  std::vector<uint32_t> around(const SurfacePoint& click) const {
    std::vector<uint32_t> found;
    index_.any_within(click.position, reach_, [&](size_t i) {
      if (dot(points_.normals[i], click.normal) > 0) found.push_back(uint32_t(i));
      return false;
    });
    if (found.empty()) found.push_back(nearest(click));
    return found;
  }

  uint32_t nearest(const SurfacePoint& click) const {
    uint32_t best = 0;
    float smallest = 1e30f;
    for (uint32_t i = 0; i < points_.positions.size(); ++i) {
      const Vec3f d = points_.positions[i] - click.position;
      // Points on the other side count as far.
      const float distance = dot(d, d) + (dot(points_.normals[i], click.normal) > 0 ? 0 : 4);
      if (distance < smallest) smallest = distance, best = i;
    }
    return best;
  }

 private:
  const HandlerPoints& points_;
  float reach_;  // unit frame
  PointIndex index_;
};

// Seeds of the points around; those around both kinds get none.
std::vector<Seed> seeds_around(const Clicks& clicks, size_t points, std::span<const SurfacePoint> positive,
                               std::span<const SurfacePoint> negative) {
  std::vector<Seed> seeds(points, Seed::none);
  std::vector<uint8_t> both(points, 0);
  const auto put = [&](std::span<const SurfacePoint> list, Seed kind) {
    for (const SurfacePoint& click : list)
      for (const uint32_t i : clicks.around(click)) {
        both[i] |= seeds[i] != Seed::none && seeds[i] != kind;
        seeds[i] = kind;
      }
  };
  put(positive, Seed::positive);
  put(negative, Seed::negative);
  for (size_t i = 0; i < points; ++i)
    if (both[i]) seeds[i] = Seed::none;
  return seeds;
}

}  // namespace

std::vector<Seed> click_seeds(const HandlerPoints& points, std::span<const SurfacePoint> positive,
                              std::span<const SurfacePoint> negative) {
  const Clicks clicks(points, kClickReach);
  std::vector<Seed> seeds = seeds_around(clicks, points.positions.size(), positive, negative);
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

std::vector<Seed> stroke_seeds(const HandlerPoints& points, std::span<const SurfacePoint> positive,
                               std::span<const SurfacePoint> negative) {
  return seeds_around(Clicks(points, kStrokeReach), points.positions.size(), positive, negative);
}

std::vector<float> grow(const HandlerPoints& points, std::span<const Vec3f> albedo,
                        std::span<const Seed> seeds, const GraphOptions& options) {
  const PointGraph graph = point_graph(points, albedo, options);
  const std::vector<uint8_t> side = compete(graph, seeds);
  return random_walk(graph, seeds, std::vector<float>(side.begin(), side.end()));
}

}  // namespace cei3d
