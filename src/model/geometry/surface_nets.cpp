// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/surface_nets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "model/geometry/sdf_normals.h"

namespace cei3d {

namespace {

// Signed distances at the corners of a grid, exact near the surface, of the right sign elsewhere.
struct CornerGrid {
  int n;  // corners along an axis
  std::vector<float> value;
  size_t index(int x, int y, int z) const { return (size_t(z) * n + y) * n + x; }
  Vec3f position(int x, int y, int z) const {
    const float s = 2.0f / float(n - 1);
    return {float(x) * s - 1, float(y) * s - 1, float(z) * s - 1};
  }
};

CornerGrid sample_corners(const Device& device, const Field& sdf, int resolution) {
  constexpr int kFactor = 4;
  CornerGrid coarse{resolution / kFactor + 1, {}}, fine{resolution + 1, {}};
  std::vector<Vec3f> points;
  for (int z = 0; z < coarse.n; ++z)
    for (int y = 0; y < coarse.n; ++y)
      for (int x = 0; x < coarse.n; ++x) points.push_back(coarse.position(x, y, z));
  coarse.value = first_output(device, sdf, points);

  const float reach =
      2.0f * 3.4641f / float(coarse.n - 1);  // two coarse half-diagonals: fields are not quite 1-Lipschitz
  fine.value.assign(size_t(fine.n) * fine.n * fine.n, 0);
  std::vector<size_t> wanted;
  points.clear();
  for (int z = 0; z < fine.n; ++z)
    for (int y = 0; y < fine.n; ++y)
      for (int x = 0; x < fine.n; ++x) {
        const auto near = [](int k) { return (k + kFactor / 2) / kFactor; };
        const float c = coarse.value[coarse.index(near(x), near(y), near(z))];
        fine.value[fine.index(x, y, z)] = c;
        if (std::abs(c) > reach) continue;
        wanted.push_back(fine.index(x, y, z));
        points.push_back(fine.position(x, y, z));
      }
  const std::vector<float> exact = first_output(device, sdf, points);
  for (size_t i = 0; i < wanted.size(); ++i) fine.value[wanted[i]] = exact[i];
  // Outside the unit sphere there is nothing, whatever the untrained field says.
  for (int z = 0; z < fine.n; ++z)
    for (int y = 0; y < fine.n; ++y)
      for (int x = 0; x < fine.n; ++x) {
        const float outside = length(fine.position(x, y, z)) - 1;
        float& v = fine.value[fine.index(x, y, z)];
        v = std::max(v, outside);
      }
  return fine;
}

// Mean of the zero crossings on the cell's edges; false when the surface does not pass.
bool cell_vertex(const CornerGrid& g, int x, int y, int z, Vec3f& out) {
  float f[8];
  int inside = 0;
  for (int k = 0; k < 8; ++k) {
    f[k] = g.value[g.index(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2))];
    inside += f[k] < 0;
  }
  if (inside == 0 || inside == 8) return false;
  Vec3f sum{0, 0, 0};
  int count = 0;
  for (int a = 0; a < 8; ++a)
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | 1 << axis;
      if (b == a || (f[a] < 0) == (f[b] < 0)) continue;
      Vec3f p{float(a & 1), float(a >> 1 & 1), float(a >> 2)};
      p[axis] = f[a] / (f[a] - f[b]);
      sum += p;
      ++count;
    }
  const Vec3f lo = g.position(x, y, z);
  out = lo + sum * (2.0f / float(g.n - 1) / float(count));
  return true;
}

Mesh net_of(const CornerGrid& g) {
  Mesh mesh;
  constexpr uint32_t kNone = ~0u;
  const int cells = g.n - 1;
  std::vector<uint32_t> vertex(size_t(cells) * cells * cells, kNone);
  const auto cell = [&](int x, int y, int z) -> uint32_t& {
    return vertex[(size_t(z) * cells + y) * cells + x];
  };
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        Vec3f p;
        if (!cell_vertex(g, x, y, z, p)) continue;
        cell(x, y, z) = uint32_t(mesh.positions.size());
        mesh.positions.push_back(p);
      }
  // Every grid edge that crosses the surface joins the four cells around it.
  for (int z = 1; z < cells; ++z)
    for (int y = 1; y < cells; ++y)
      for (int x = 1; x < cells; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          const bool here = g.value[g.index(x, y, z)] < 0;
          const bool there = g.value[g.index(x + (axis == 0), y + (axis == 1), z + (axis == 2))] < 0;
          if (here == there) continue;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          uint32_t q[4];
          for (int k = 0; k < 4; ++k) {
            int c[3] = {x, y, z};
            c[u] -= k == 0 || k == 3;
            c[v] -= k == 0 || k == 1;
            q[k] = cell(c[0], c[1], c[2]);
          }
          if (!here) std::swap(q[1], q[3]);
          mesh.triangles.push_back({q[0], q[1], q[2]});
          mesh.triangles.push_back({q[0], q[2], q[3]});
        }
  return mesh;
}

uint32_t find_root(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

void drop_small_parts(Mesh& mesh, float smallest_share) {
  std::vector<uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const auto& t : mesh.triangles)
    for (int k = 1; k < 3; ++k) parent[find_root(parent, t[k])] = find_root(parent, t[0]);
  std::vector<size_t> triangles(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles) ++triangles[find_root(parent, t[0])];
  const auto smallest = size_t(smallest_share * float(mesh.triangles.size()));
  std::erase_if(mesh.triangles, [&](const auto& t) { return triangles[find_root(parent, t[0])] < smallest; });
  std::vector<uint32_t> renamed(mesh.positions.size(), ~0u);
  std::vector<Vec3f> positions;
  for (auto& t : mesh.triangles)
    for (uint32_t& v : t) {
      if (renamed[v] == ~0u) {
        renamed[v] = uint32_t(positions.size());
        positions.push_back(mesh.positions[v]);
      }
      v = renamed[v];
    }
  mesh.positions = std::move(positions);
}

}  // namespace

Mesh extract_mesh(const Device& device, const Field& sdf, const MeshingOptions& options) {
  Mesh mesh = net_of(sample_corners(device, sdf, options.resolution));
  if (mesh.triangles.empty())
    fail("the reconstructed field has no surface: the object was lost during training");
  drop_small_parts(mesh, options.smallest_part);
  mesh.normals.resize(mesh.positions.size());
  sdf_normals(device, sdf, mesh.positions, mesh.normals);
  const float cell = 2.0f / float(options.resolution);
  for (int round = 0; round < 2; ++round) {
    const std::vector<float> d = first_output(device, sdf, mesh.positions);
    for (size_t i = 0; i < d.size(); ++i)
      mesh.positions[i] = mesh.positions[i] - mesh.normals[i] * std::clamp(d[i], -0.5f * cell, 0.5f * cell);
  }
  sdf_normals(device, sdf, mesh.positions, mesh.normals);
  return mesh;
}

}  // namespace cei3d
