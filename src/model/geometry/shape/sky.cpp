// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/sky.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/fibonacci.h"
#include "core/math/octahedron.h"

namespace cei3d {
namespace {

// Cells along a side of the octahedral square: at most a third as wide as the spacing of directions.
constexpr int kCells = 64;

std::vector<Vec3f> fibonacci_sphere(int n) {
  std::vector<Vec3f> d(n);
  // With pi in single precision: the visibility tables of stored projects are of these directions.
  const double golden = kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < n; ++i) d[i] = fibonacci_direction(i, n, golden);
  return d;
}

int cell_of(Vec3f d) {
  const Vec2f p = octahedron_from_direction(d);
  const auto step = [](float v) { return std::clamp(int((v + 1) * (0.5f * kCells)), 0, kCells - 1); };
  return step(p.y) * kCells + step(p.x);
}

Vec3f middle_of(int cell) {
  const auto at = [](int step) { return (float(step) + 0.5f) * (2.0f / kCells) - 1; };
  return direction_from_octahedron({at(cell % kCells), at(cell / kCells)});
}

SkyNeighbors nearest_to(Vec3f d) {
  const std::vector<Vec3f>& sky = sky_directions();
  std::array<uint16_t, kSkyDirections> order;
  std::iota(order.begin(), order.end(), uint16_t(0));
  SkyNeighbors out;
  std::partial_sort_copy(order.begin(), order.end(), out.begin(), out.end(),
                         [&](uint16_t a, uint16_t b) { return dot(sky[a], d) > dot(sky[b], d); });
  return out;
}

std::vector<SkyNeighbors> all_neighbors() {
  std::vector<SkyNeighbors> out;
  for (int cell = 0; cell < kCells * kCells; ++cell) out.push_back(nearest_to(middle_of(cell)));
  return out;
}

}  // namespace

const std::vector<Vec3f>& sky_directions() {
  static const std::vector<Vec3f> directions = fibonacci_sphere(kSkyDirections);
  return directions;
}

const SkyNeighbors& sky_around(Vec3f direction) {
  static const std::vector<SkyNeighbors> neighbors = all_neighbors();
  return neighbors[cell_of(direction)];
}

}  // namespace cei3d
