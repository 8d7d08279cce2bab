// SPDX-License-Identifier: Apache-2.0
#include "engine/export/tangents.h"

#include <cmath>

#include "core/math/tangents.h"

namespace cei3d {
namespace {

Vec3f flattened(Vec3f v, Vec3f normal) { return v - normal * dot(v, normal); }

}  // namespace

std::vector<Vec3f> tangents_of(std::span<const Vec3f> p, std::span<const Vec3f> normals,
                               std::span<const Vec2f> uv,
                               std::span<const std::array<uint32_t, 3>> triangles) {
  std::vector<Vec3f> sum(p.size(), {0, 0, 0});
  for (const auto& t : triangles) {
    const Vec2f e = uv[t[1]] - uv[t[0]], g = uv[t[2]] - uv[t[0]];
    const float area = signed_area(e, g);
    const Vec3f along_u = ((p[t[1]] - p[t[0]]) * g.y - (p[t[2]] - p[t[0]]) * e.y) * (area < 0 ? -1.0f : 1.0f);
    if (area == 0 || !(length(along_u) > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = t[k];
      const Vec3f n = normals[v];
      const Vec3f a = normalize(flattened(p[t[(k + 1) % 3]] - p[v], n)),
                  b = normalize(flattened(p[t[(k + 2) % 3]] - p[v], n));
      sum[v] += normalize(flattened(along_u, n)) * std::acos(clamp(dot(a, b), -1.0f, 1.0f));
    }
  }
  for (size_t v = 0; v < sum.size(); ++v)
    sum[v] = length(sum[v]) > 1e-6f ? normalize(sum[v]) : tangents_of(normals[v]).x;
  return sum;
}

Vec3f TangentFrame::coordinates(Vec3f d) const {
  const Vec3f bitangent = cross(normal, tangent);
  const Mat3f frame = transpose(Mat3f{{tangent, bitangent, normal}});
  return normalize(inverse(frame) * d);
}

Vec3f TangentFrame::direction(Vec3f c) const {
  return normalize(tangent * c.x + cross(normal, tangent) * c.y + normal * c.z);
}

}  // namespace cei3d
