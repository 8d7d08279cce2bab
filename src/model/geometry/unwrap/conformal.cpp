// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/conformal.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/math/mirror.h"
#include "model/geometry/mesh/sparse.h"

namespace cei3d {
namespace {

using Complex = std::complex<double>;

// A triangle in its own plane: corners a = 0, b on the x axis, c above it.
struct FlatTriangle {
  double bx, cx, cy;
  double area() const { return bx * cy / 2; }
};

FlatTriangle flat(const Patch2d& patch, const std::array<uint32_t, 3>& t) {
  const Vec3d a = to_double(patch.points[t[0]]), b = to_double(patch.points[t[1]]) - a,
              c = to_double(patch.points[t[2]]) - a;
  const double bx = std::sqrt(dot(b, b));
  if (!(bx > 0)) return {0, 0, 0};
  return {bx, dot(b, c) / bx, length(cross(b, c)) / bx};
}

double area_of(const Patch2d& patch) {
  double sum = 0;
  for (const auto& t : patch.triangles) sum += flat(patch, t).area();
  return sum;
}

double area_of(const Patch2d& patch, std::span<const Vec2d> uv) {
  double sum = 0;
  for (const auto& [a, b, c] : patch.triangles) sum += signed_area(uv[b] - uv[a], uv[c] - uv[a]) / 2;
  return sum;
}

std::vector<Vec2d> scaled_to(double area, const Patch2d& patch, std::vector<Vec2d> uv) {
  const double now = area_of(patch, uv);
  const double scale = now > 0 ? std::sqrt(area / now) : 1;
  for (Vec2d& p : uv) p = p * scale;
  return uv;
}

// The vertex farthest from another one.
uint32_t farthest(const Patch2d& patch, uint32_t from) {
  uint32_t best = from;
  float largest = 0;
  for (uint32_t v = 0; v < patch.points.size(); ++v) {
    const Vec3f d = patch.points[v] - patch.points[from];
    if (dot(d, d) > largest) largest = dot(d, d), best = v;
  }
  return best;
}

// The quadratic form of the conformal energy over u and v of all vertices, in turn. With w_k the edges
// opposite to the corners as complex numbers of the triangle's plane, the energy of a triangle is |sum w_k
// z_k|^2 / (2 area), z = u + i v.
void add_energy(const FlatTriangle& f, const std::array<uint32_t, 3>& t, std::vector<SparseEntry>& entries) {
  constexpr double kThin = 1e-3;  // thinner triangles than that weigh no more
  const double longest =
      std::max({f.bx * f.bx, f.cx * f.cx + f.cy * f.cy, (f.cx - f.bx) * (f.cx - f.bx) + f.cy * f.cy});
  const double norm = 1 / std::max(2 * f.area(), kThin * longest);
  const Complex w[3] = {{f.cx - f.bx, f.cy}, {-f.cx, -f.cy}, {f.bx, 0}};
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) {
      const Complex h = std::conj(w[j]) * w[k] * norm;
      const int row = 2 * int(t[j]), column = 2 * int(t[k]);
      entries.push_back({row, column, h.real()});
      entries.push_back({row + 1, column + 1, h.real()});
      entries.push_back({row, column + 1, -h.imag()});
      entries.push_back({row + 1, column, h.imag()});
    }
}

}  // namespace

std::vector<Vec2d> projection(const Patch2d& patch) {
  const Vec3f n = patch.axis, aside = std::abs(n.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
  const Vec3f x = normalize(cross(aside, n)), y = cross(n, x);
  std::vector<Vec2d> uv;
  for (const Vec3f& p : patch.points) {
    const Vec3f d = p - patch.points[0];
    uv.push_back({double(dot(d, x)), double(dot(d, y))});
  }
  return scaled_to(area_of(patch), patch, std::move(uv));
}

std::vector<Vec2d> conformal_map(const Patch2d& patch) {
  const double area = area_of(patch);
  if (!(area > 0)) return projection(patch);
  // Two pinned vertices take away the freedom to turn, to move and to scale.
  constexpr double kPin = 10, kStay = 1e-9;
  const uint32_t a = farthest(patch, 0), b = farthest(patch, a);
  const double apart = length(to_double(patch.points[b] - patch.points[a]));
  std::vector<SparseEntry> entries;
  for (const auto& t : patch.triangles) {
    const FlatTriangle f = flat(patch, t);
    if (f.bx > 0) add_energy(f, t, entries);
  }
  const int n = 2 * int(patch.points.size());
  std::vector<double> right(size_t(n), 0.0);
  for (int i = 0; i < n; ++i) entries.push_back({i, i, kStay});
  for (const uint32_t v : {a, b})
    for (int c = 0; c < 2; ++c) entries.push_back({2 * int(v) + c, 2 * int(v) + c, kPin});
  right[2 * size_t(b)] = kPin * apart;
  const std::vector<double> x = SparseSolver(n, entries).solve(right);
  std::vector<Vec2d> uv;
  for (size_t v = 0; v < patch.points.size(); ++v) uv.push_back({x[2 * v], x[2 * v + 1]});
  return scaled_to(area, patch, std::move(uv));
}

Stretch stretch_of(const Patch2d& patch, std::span<const Vec2d> uv) {
  constexpr double kFlat = 1e-9;  // of the area of an equilateral triangle of that longest edge, squared
  Stretch out;
  double sum = 0, surface = 0, map = 0;
  for (const auto& t : patch.triangles) {
    const FlatTriangle f = flat(patch, t);
    const Vec2d e = uv[t[1]] - uv[t[0]], g = uv[t[2]] - uv[t[0]];
    const double in_map = signed_area(e, g) / 2;
    if (f.area() <= kFlat * (f.bx * f.bx + f.cy * f.cy + f.cx * f.cx)) continue;
    if (!(in_map > 1e-6 * f.area())) {
      out.flipped = true;
      continue;
    }
    // d(surface)/du and d(surface)/dv, in the triangle's plane.
    const double ux = f.bx * g.y - f.cx * e.y, uy = -f.cy * e.y;
    const double vx = f.cx * e.x - f.bx * g.x, vy = f.cy * e.x;
    sum += f.area() * (ux * ux + uy * uy + vx * vx + vy * vy) / (8 * in_map * in_map);
    surface += f.area();
    map += in_map;
  }
  if (surface > 0) out.l2 = std::sqrt(sum / surface * map / surface);
  return out;
}

}  // namespace cei3d
