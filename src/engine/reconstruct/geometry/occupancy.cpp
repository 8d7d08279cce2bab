// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/occupancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/ray_sphere.h"
#include "core/math/trilinear.h"

namespace cei3d {

OccupancyGrid::OccupancyGrid(int resolution) : n_(resolution), value_(size_t(n_) * n_ * n_) {
  if (n_ % 4 != 0)
    fail("An occupancy grid needs a multiple of 4 cells per axis, not {} (an error in the program).", n_);
  // The value that set() stores for far away, so that a grid that is saved and loaded has the same bits.
  for (size_t i = 0; i < value_.size(); ++i) set_distance(i, std::numeric_limits<float>::max());
}

void OccupancyGrid::set_distance(size_t place, float d) {
  constexpr float kMaxDistance = 3.9f;
  value_[place] = int16_t(std::lround(std::clamp(d, -kMaxDistance, kMaxDistance) / kUnit));
}

void OccupancyGrid::set(std::span<const float> values) {
  for (size_t i = 0; i < values.size(); ++i) set_distance(place(int(i)), values[i]);
}

std::vector<float> OccupancyGrid::values() const {
  std::vector<float> out(value_.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = distance(place(int(i)));
  return out;
}

Vec3f OccupancyGrid::center(int i) const { return center_of(place(i)); }

Vec3f OccupancyGrid::center_of(size_t place) const {
  const size_t bricks = size_t(n_) / 4, brick = place / 64;
  const auto at = [&](size_t brick_at, size_t in_brick) {
    return (float(4 * brick_at + in_brick % 4) + 0.5f) * 2 / float(n_) - 1;
  };
  return {at(brick % bricks, place), at(brick / bricks % bricks, place / 4),
          at(brick / bricks / bricks, place / 16)};
}

namespace {

constexpr int kChunk = 1 << 14;
// Number of points between two checks for interruption: with the largest networks 2 to 4 s of one core.
constexpr size_t kSlab = 1 << 15;

std::vector<float> distances_at(const Device& device, const Field& sdf, std::span<const Vec3f> points,
                                const Progress& progress) {
  std::vector<float> out;
  out.reserve(points.size());
  for (size_t begin = 0; begin < points.size(); begin += kSlab) {
    check_cancelled(progress);
    const std::vector<float> some =
        first_output(device, sdf, points.subspan(begin, std::min(kSlab, points.size() - begin)));
    out.insert(out.end(), some.begin(), some.end());
  }
  return out;
}

}  // namespace

void OccupancyGrid::refresh(const Device& device, const Field& sdf, float margin, const Progress& progress) {
  const int all = int(value_.size()), chunks = (all + kChunk - 1) / kChunk;
  std::vector<std::vector<uint32_t>> near(chunks);
  parallel_for(chunks, [&](int c) {
    for (int i = c * kChunk; i < std::min(all, (c + 1) * kChunk); ++i) {
      if (std::abs(distance(size_t(i))) > margin) continue;
      const Vec3f p = center_of(size_t(i));
      if (dot(p, p) <= 1.1f) near[c].push_back(uint32_t(i));
    }
  });
  std::vector<uint32_t> places;
  for (const auto& n : near) places.insert(places.end(), n.begin(), n.end());
  std::vector<Vec3f> points(places.size());
  parallel_ranges(int(places.size()), kChunk, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) points[k] = center_of(places[k]);
  });
  const std::vector<float> out = distances_at(device, sdf, points, progress);
  parallel_ranges(int(places.size()), kChunk, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) set_distance(places[k], out[k]);
  });
}

float OccupancyGrid::interpolated(Vec3f p) const {
  return kUnit * trilinear(p, n_, [&](int x, int y, int z) { return float(value_[place(x, y, z)]); });
}

// Takes one step; false where the walk ends.
bool OccupancyGrid::advance(const Ray& ray, const March& m, Walk& walk, float* depths) const {
  if (walk.t >= walk.far || walk.found >= m.max_depths) return false;
  const Vec3f p = ray.origin + ray.direction * walk.t;
  // The distance of a point differs from that of its cell by half a diagonal at most; interpolation between
  // cells is better than that.
  float reach = m.band + half_diagonal(), d = at(p);
  if (std::abs(d) <= reach) {
    d = interpolated(p);
    reach = m.band + m.slack * half_diagonal();
  }
  if (d < -reach) {
    walk.far = walk.t;
    return false;
  }
  // Away from the surface no sample keeps the gradient of the field at unit length: sphere tracing with the
  // full distance could overshoot the surface, and the ray would miss it.
  const bool is_empty = d > reach;
  if (!is_empty) depths[walk.found++] = walk.t;
  walk.t += is_empty ? std::max(0.5f * (d - reach), m.step) : m.step;
  return true;
}

void OccupancyGrid::march(std::span<const Ray> rays, const March& m, std::span<const float> jitter,
                          std::vector<float>& depths, std::span<int> counts) const {
  constexpr size_t kTogether = 8;  // interleaved walks hide the latency of each other's cache misses
  std::vector<float> found(kTogether * size_t(m.max_depths));
  for (size_t first = 0; first < rays.size(); first += kTogether) {
    const size_t n = std::min(kTogether, rays.size() - first);
    Walk walks[kTogether];
    for (size_t k = 0; k < n; ++k)
      if (const SphereSpan<float> s = sphere_span(rays[first + k], 1); s.near < s.far)
        walks[k] = {.t = s.near + jitter[first + k] * m.step, .far = s.far};
    for (bool going = true; going;) {
      going = false;
      for (size_t k = 0; k < n; ++k)
        going |= advance(rays[first + k], m, walks[k], &found[k * size_t(m.max_depths)]);
    }
    for (size_t k = 0; k < n; ++k) {
      const float* own = &found[k * size_t(m.max_depths)];
      depths.insert(depths.end(), own, own + walks[k].found);
      counts[first + k] = walks[k].found;
    }
  }
}

}  // namespace cei3d
