// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/surface_gradient.h"

#include "core/base/parallel.h"
#include "model/geometry/mesh/adjacency.h"
#include "model/geometry/mesh/rotation.h"

namespace cei3d {
namespace {

Mat3d cofactors(const Mat3d& m) {
  return {{cross(m.row[1], m.row[2]), cross(m.row[2], m.row[0]), cross(m.row[0], m.row[1])}};
}

double determinant(const Mat3d& m) { return dot(m.row[0], cross(m.row[1], m.row[2])); }

void add_outer(Mat3d& sum, Vec3d a, Vec3d b, double scale) {
  for (int i = 0; i < 3; ++i) sum.row[i] += b * (a[i] * scale);
}

struct Ring {
  std::span<const Vec3f> before, after;
  std::span<const uint32_t> neighbors;
};

// Least-squares F that maps the ring's edges before to those after. The unit normal n is mapped by the ring's
// rotation, because the edges do not determine it.
Mat3d fit(const Ring& ring, uint32_t v, Vec3d n) {
  Mat3d moments{}, products{};
  double size = 0;
  for (const uint32_t u : ring.neighbors) {
    const Vec3d e = to_double(ring.before[u] - ring.before[v]), d = to_double(ring.after[u] - ring.after[v]);
    add_outer(moments, e, e, 1);
    add_outer(products, d, e, 1);
    size += dot(e, e);
  }
  if (!(size > 0)) return Mat3d::identity();
  const Vec3d turned = nearest_rotation(products) * n;
  add_outer(moments, n, n, size);
  add_outer(products, turned, n, size);
  const double det = determinant(moments);
  if (!(det > 1e-9 * size * size * size)) return nearest_rotation(products);  // all edges along one line
  Mat3d f = products * cofactors(moments);  // symmetric, so the cofactors are the adjugate
  for (Vec3d& row : f.row) row = row / det;
  return f;
}

}  // namespace

SurfaceGradient surface_gradient(std::span<const Vec3f> before, std::span<const Vec3f> normals,
                                 std::span<const Vec3f> after,
                                 std::span<const std::array<uint32_t, 3>> triangles,
                                 std::span<const uint32_t> vertices) {
  const VertexLists neighbors = neighbors_of(before.size(), triangles);
  SurfaceGradient result{std::vector<std::array<float, 9>>(vertices.size()),
                         std::vector<Vec3f>(vertices.size())};
  parallel_ranges(int(vertices.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const uint32_t v = vertices[i];
      const Vec3d n = to_double(normals[v]);
      Mat3d f = fit({before, after, neighbors.of(v)}, v, n);
      Vec3d m = normalize(cofactors(f) * n);  // F^-T n, up to the sign of det F
      if (dot(m, f * n) < 0) m = -m;
      add_outer(f, m - f * n, n, 1);
      result.normals[i] = to_float(m);
      for (int k = 0; k < 9; ++k) result.gradients[i][k] = float(f.row[k / 3][k % 3]);
    }
  });
  return result;
}

}  // namespace cei3d
