// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/occupancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace cei3d {

bool unit_sphere_span(const Ray& ray, float& near, float& far) {
  const float b = dot(ray.origin, ray.direction), c = dot(ray.origin, ray.origin) - 1, disc = b * b - c;
  if (disc <= 0) return false;
  const float root = std::sqrt(disc);
  near = std::max(0.0f, -b - root);
  far = -b + root;
  return far > near;
}

OccupancyGrid::OccupancyGrid(int resolution)
    : n_(resolution), value_(size_t(n_) * n_ * n_, std::numeric_limits<int16_t>::max()) {
  if (n_ % 4 != 0) fail("an occupancy grid of {} cells an axis: bricks have 4", n_);
}

void OccupancyGrid::set_distance(size_t place, float d) {
  constexpr float kMost = 3.9f;
  value_[place] = int16_t(std::lround(std::clamp(d, -kMost, kMost) / kUnit));
}

void OccupancyGrid::set(std::span<const float> values) {
  for (size_t i = 0; i < values.size(); ++i) set_distance(place(int(i)), values[i]);
}

std::vector<float> OccupancyGrid::values() const {
  std::vector<float> out(value_.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = distance(place(int(i)));
  return out;
}

Vec3f OccupancyGrid::center(int i) const {
  const auto at = [&](int k) { return (float(k) + 0.5f) * 2 / float(n_) - 1; };
  return {at(i % n_), at(i / n_ % n_), at(i / n_ / n_)};
}

void OccupancyGrid::refresh(const Device& device, const Field& sdf, float margin) {
  std::vector<int> cells;
  std::vector<Vec3f> points;
  for (int i = 0; i < int(value_.size()); ++i) {
    if (std::abs(distance(place(i))) > margin) continue;
    const Vec3f p = center(i);
    if (dot(p, p) > 1.1f) continue;
    cells.push_back(i);
    points.push_back(p);
  }
  const std::vector<float> out = first_output(device, sdf, points);
  for (size_t k = 0; k < cells.size(); ++k) set_distance(place(cells[k]), out[k]);
}

// Looks at one cell; false at the walk's end.
bool OccupancyGrid::advance(const Ray& ray, float step, float band, int most, Walk& walk,
                            float* depths) const {
  if (walk.t >= walk.far || walk.found >= most) return false;
  const float reach = band + half_diagonal(), d = at(ray.origin + ray.direction * walk.t);
  if (d < -reach) {
    walk.far = walk.t;
    return false;
  }
  // A cell's distance is off by half its diagonal at most. Away from the surface nothing holds the field's
  // slope at one: a leap of all of it would land behind the surface, and the ray find nothing.
  const bool leap = d > reach;
  if (!leap) depths[walk.found++] = walk.t;
  walk.t += leap ? std::max(0.5f * (d - reach), step) : step;
  return true;
}

void OccupancyGrid::march(std::span<const Ray> rays, float step, float band, std::span<const float> jitter,
                          int most, std::vector<float>& depths, std::span<int> counts) const {
  constexpr size_t kTogether = 8;  // walks take turns: one's cells come from memory while others go on
  std::vector<float> found(kTogether * size_t(most));
  for (size_t first = 0; first < rays.size(); first += kTogether) {
    const size_t n = std::min(kTogether, rays.size() - first);
    Walk walks[kTogether];
    for (size_t k = 0; k < n; ++k)
      if (unit_sphere_span(rays[first + k], walks[k].t, walks[k].far)) walks[k].t += jitter[first + k] * step;
    for (bool going = true; going;) {
      going = false;
      for (size_t k = 0; k < n; ++k)
        going |= advance(rays[first + k], step, band, most, walks[k], &found[k * size_t(most)]);
    }
    for (size_t k = 0; k < n; ++k) {
      const float* own = &found[k * size_t(most)];
      depths.insert(depths.end(), own, own + walks[k].found);
      counts[first + k] = walks[k].found;
    }
  }
}

}  // namespace cei3d
