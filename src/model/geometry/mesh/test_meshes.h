// SPDX-License-Identifier: Apache-2.0
// Meshes with known shapes, for tests.
#pragma once

#include <algorithm>
#include <map>
#include <utility>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// A tetrahedron with normals and colors at its corners.
inline Mesh tetrahedron() {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const Vec3f p : m.positions) {
    m.normals.push_back(normalize(p - Vec3f{0.2f, 0.3f, 0.4f}));
    m.colors.push_back(p * 0.3f);
  }
  return m;
}

// A flat rectangle of nx x ny squares in the plane z = 0, its corner at the origin, normals +z.
inline Mesh plane_mesh(int nx, int ny, float cell) {
  Mesh m;
  for (int y = 0; y <= ny; ++y)
    for (int x = 0; x <= nx; ++x) m.positions.push_back({float(x) * cell, float(y) * cell, 0});
  m.normals.assign(m.positions.size(), Vec3f{0, 0, 1});
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const uint32_t a = uint32_t(y * (nx + 1) + x), b = a + uint32_t(nx) + 1;
      m.triangles.push_back({a, a + 1, b});
      m.triangles.push_back({b, a + 1, b + 1});
    }
  return m;
}

// A closed sphere around the origin: an octahedron whose triangles are split in four `levels` times.
inline Mesh sphere_mesh(float radius, int levels) {
  Mesh m;
  m.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  m.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), uint32_t(m.positions.size()));
      if (fresh) m.positions.push_back(normalize(m.positions[a] + m.positions[b]));
      return at->second;
    };
    std::vector<std::array<uint32_t, 3>> finer;
    for (const auto [a, b, c] : m.triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    m.triangles = std::move(finer);
  }
  m.normals = m.positions;
  for (Vec3f& p : m.positions) p = p * radius;
  return m;
}

// The closed surface of a box of nx x ny x nz cubes, its corner at the origin; no normals.
inline Mesh box_mesh(int nx, int ny, int nz, float cell) {
  Mesh m;
  std::map<std::array<int, 3>, uint32_t> corners;
  const auto corner = [&](std::array<int, 3> p) {
    const auto [at, fresh] = corners.try_emplace(p, uint32_t(m.positions.size()));
    if (fresh) m.positions.push_back(Vec3f{float(p[0]), float(p[1]), float(p[2])} * cell);
    return at->second;
  };
  const int size[3] = {nx, ny, nz};
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int side : {0, size[axis]})
      for (int i = 0; i < size[u]; ++i)
        for (int j = 0; j < size[v]; ++j) {
          std::array<int, 3> p{};
          p[axis] = side, p[u] = i, p[v] = j;
          const auto at = [&](int di, int dj) {
            auto q = p;
            q[u] += di, q[v] += dj;
            return corner(q);
          };
          std::array<uint32_t, 4> q{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
          if (side == 0) std::swap(q[1], q[3]);
          m.triangles.push_back({q[0], q[1], q[2]});
          m.triangles.push_back({q[0], q[2], q[3]});
        }
  }
  return m;
}

}  // namespace cei3d
