// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/surface_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {

namespace {

// Signed distances at the corners of a grid over [-1, 1]^3, exact near the surface, of correct sign
// elsewhere. Computed one layer at a time, because a fine grid would not fit in memory beside the rest.
class Corners {
 public:
  Corners(const DistancesAt& distances, int resolution)
      : distances_(distances), n_(resolution + 1), coarse_n_(resolution / kFactor + 1) {
    std::vector<Vec3f> points;
    for (int z = 0; z < coarse_n_; ++z)
      for (int y = 0; y < coarse_n_; ++y)
        for (int x = 0; x < coarse_n_; ++x) points.push_back(position(x, y, z, coarse_n_));
    coarse_ = distances_(points);
  }
  int cells() const { return n_ - 1; }
  Vec3f position(int x, int y, int z) const { return position(x, y, z, n_); }

  std::vector<float> layer(int z) const {  // [y][x]
    // Two coarse diagonals of margin: fields are not quite 1-Lipschitz.
    const float reach = 2.0f * 3.4641f / float(coarse_n_ - 1);
    std::vector<float> values(size_t(n_) * n_);
    std::vector<size_t> wanted;
    std::vector<Vec3f> points;
    for (int y = 0; y < n_; ++y)
      for (int x = 0; x < n_; ++x) {
        const size_t i = size_t(y) * n_ + x;
        values[i] = coarse_near(x, y, z);
        if (std::abs(values[i]) > reach) continue;
        wanted.push_back(i);
        points.push_back(position(x, y, z));
      }
    const std::vector<float> exact = distances_(points);
    for (size_t k = 0; k < wanted.size(); ++k) values[wanted[k]] = exact[k];
    // Outside the unit sphere the field is not trained; there is no surface there.
    for (int y = 0; y < n_; ++y)
      for (int x = 0; x < n_; ++x) {
        float& v = values[size_t(y) * n_ + x];
        v = std::max(v, length(position(x, y, z)) - 1);
      }
    return values;
  }

 private:
  static constexpr int kFactor = 4;

  static Vec3f position(int x, int y, int z, int n) {
    const float s = 2.0f / float(n - 1);
    return {float(x) * s - 1, float(y) * s - 1, float(z) * s - 1};
  }
  float coarse_near(int x, int y, int z) const {
    const auto near = [](int k) { return size_t(k + kFactor / 2) / kFactor; };
    return coarse_[(near(z) * coarse_n_ + near(y)) * coarse_n_ + near(x)];
  }

  const DistancesAt& distances_;
  int n_, coarse_n_;  // corners along an axis
  std::vector<float> coarse_;
};

// The values at a cell's corners; bit 0 of the index is x, bit 1 y, bit 2 z.
std::array<float, 8> cell_values(const std::vector<float>& bottom, const std::vector<float>& top, int x,
                                 int y, int n) {
  std::array<float, 8> f;
  for (int k = 0; k < 8; ++k) f[k] = (k & 4 ? top : bottom)[size_t(y + (k >> 1 & 1)) * n + x + (k & 1)];
  return f;
}

// Mean of the zero crossings on the cell's edges, in cells from its low corner; false when the surface does
// not pass through the cell.
bool cell_vertex(const std::array<float, 8>& f, Vec3f& out) {
  const auto inside = std::count_if(f.begin(), f.end(), [](float v) { return v < 0; });
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
  out = sum * (1 / float(count));
  return true;
}

// Vertex of each cell in the two layers below and above a layer of corners.
struct VertexLayers {
  std::vector<uint32_t> below, above;  // [y][x]
};

// Joins the four cells around every grid edge that crosses the surface: the edges in the layer `bottom` and
// from there up to `top`.
void join_cells(const VertexLayers& vertices, const std::vector<float>& bottom, const std::vector<float>& top,
                int cells, Mesh& mesh) {
  const int n = cells + 1;
  for (int y = 1; y < cells; ++y)
    for (int x = 1; x < cells; ++x)
      for (int axis = 0; axis < 3; ++axis) {
        const size_t corner = size_t(y) * n + x;
        const bool here = bottom[corner] < 0;
        const bool there = (axis == 0   ? bottom[corner + 1]
                            : axis == 1 ? bottom[corner + n]
                                        : top[corner]) < 0;
        if (here == there) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        uint32_t q[4];
        for (int k = 0; k < 4; ++k) {
          int back[3] = {0, 0, 0};
          back[u] = k == 0 || k == 3;
          back[v] = k == 0 || k == 1;
          const std::vector<uint32_t>& layer = back[2] ? vertices.below : vertices.above;
          q[k] = layer[size_t(y - back[1]) * cells + size_t(x - back[0])];
        }
        if (!here) std::swap(q[1], q[3]);
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
      }
}

Mesh net_of(const Corners& corners, const Progress& progress) {
  Mesh mesh;
  const int cells = corners.cells();
  const float size = 2.0f / float(cells);
  VertexLayers vertices;
  std::vector<float> bottom = corners.layer(0);
  for (int z = 0; z < cells; ++z) {
    check_cancelled(progress);
    std::vector<float> top = corners.layer(z + 1);
    vertices.above.assign(size_t(cells) * cells, ~0u);
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        Vec3f in_cell;
        if (!cell_vertex(cell_values(bottom, top, x, y, cells + 1), in_cell)) continue;
        vertices.above[size_t(y) * cells + x] = uint32_t(mesh.positions.size());
        mesh.positions.push_back(corners.position(x, y, z) + in_cell * size);
      }
    if (z > 0) join_cells(vertices, bottom, top, cells, mesh);
    std::swap(vertices.below, vertices.above);
    bottom = std::move(top);
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

// Moves vertices of the net along their normals, by `max_step` at most a round, and sets their normals.
void move_to_zero(const Device& device, const Field& sdf, float max_step, std::span<Vec3f> positions,
                  std::span<Vec3f> normals) {
  sdf_normals(device, sdf, positions, normals);
  for (int round = 0; round < 2; ++round) {
    const std::vector<float> d = first_output(device, sdf, positions);
    for (size_t i = 0; i < d.size(); ++i)
      positions[i] = positions[i] - normals[i] * std::clamp(d[i], -max_step, max_step);
  }
  sdf_normals(device, sdf, positions, normals);
}

}  // namespace

Mesh surface_net(const DistancesAt& distances, int resolution, const Progress& progress) {
  return net_of(Corners(distances, resolution), progress);
}

Mesh extract_mesh(const Device& device, const Field& sdf, const MeshingOptions& options,
                  const Progress& progress) {
  Mesh mesh = surface_net([&](std::span<const Vec3f> points) { return first_output(device, sdf, points); },
                          options.resolution, progress);
  if (mesh.triangles.empty())
    fail(
        "The reconstructed field has no surface: the object was lost during training. Check the masks and "
        "the "
        "camera poses.");
  drop_small_parts(mesh, options.smallest_part);
  mesh.normals.resize(mesh.positions.size());
  constexpr size_t kSlab = 1 << 13;  // vertices between two checks: with the largest networks 7 s of one core
  for (size_t begin = 0; begin < mesh.positions.size(); begin += kSlab) {
    check_cancelled(progress);
    const size_t n = std::min(kSlab, mesh.positions.size() - begin);
    move_to_zero(device, sdf, 1.0f / float(options.resolution), std::span(mesh.positions).subspan(begin, n),
                 std::span(mesh.normals).subspan(begin, n));
  }
  return mesh;
}

}  // namespace cei3d
