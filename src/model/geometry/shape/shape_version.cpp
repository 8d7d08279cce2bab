// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/shape_version.h"

#include <algorithm>

namespace cei3d {
namespace {

using Corners = std::array<uint32_t, 3>;

// #V of the new mesh, 1 at vertices that the change moved or added.
std::vector<uint8_t> changed_vertices(const Mesh& before, const Reshape& change) {
  std::vector<uint8_t> mask(before.positions.size() + change.added_positions.size(), 0);
  for (const uint32_t v : change.moved) mask[v] = 1;
  std::fill(mask.begin() + before.positions.size(), mask.end(), uint8_t(1));
  return mask;
}

std::vector<Mat3f> next_gradients(const ShapeVersion& before, size_t vertices, const Reshape& change) {
  std::vector<Mat3f> f = before.gradients;
  f.resize(vertices, Mat3f::identity());
  for (size_t i = 0; i < change.moved.size(); ++i) {
    Mat3f& m = f[change.moved[i]];
    m = change.gradient(i) * m;
  }
  return f;
}

std::vector<Vec3f> next_colors(const ShapeVersion& before, size_t vertices, const Reshape& change) {
  std::vector<Vec3f> colors = before.colors;
  colors.resize(vertices, {0, 0, 0});
  for (size_t i = 0; i < change.rim.size(); ++i) colors[change.rim[i]] = change.rim_colors[i];
  std::copy(change.added_colors.begin(), change.added_colors.end(),
            colors.end() - change.added_colors.size());
  return colors;
}

// Sets the ids of triangles and the versions they were made and shaped in.
void follow_triangles(const ShapeVersion& before, int index, const Reshape& change,
                      std::span<const uint8_t> moved, ShapeVersion& version) {
  const auto& triangles = version.surface->mesh().triangles;
  version.before = kept_triangles(before.surface->mesh(), change);
  for (size_t t = 0; t < version.before.size(); ++t) {
    const Corners& c = triangles[t];
    version.born.push_back(before.born_in(version.before[t]));
    version.shaped.push_back(moved[c[0]] || moved[c[1]] || moved[c[2]] ? index
                                                                       : before.shaped_in(version.before[t]));
  }
  version.born.resize(triangles.size(), index);
  version.shaped.resize(triangles.size(), index);
  version.before.resize(triangles.size(), 0);
}

}  // namespace

ShapeVersions with_version(ShapeVersions versions, std::shared_ptr<const Surface> surface,
                           const Reshape& change, std::shared_ptr<const Field> sdf) {
  if (versions.empty())
    versions.push_back(
        std::make_shared<const ShapeVersion>(ShapeVersion{surface, {}, {}, {}, {}, {}, nullptr}));
  const ShapeVersion& before = *versions.back();
  Mesh mesh = apply(surface->mesh(), change);
  const size_t vertices = mesh.positions.size();
  const std::vector<uint8_t> changed = changed_vertices(surface->mesh(), change);
  auto version = std::make_shared<ShapeVersion>();
  version->surface = std::make_shared<const Surface>(std::move(mesh), *surface, changed);
  version->gradients = next_gradients(before, vertices, change);
  version->colors = next_colors(before, vertices, change);
  version->sdf = std::move(sdf);
  follow_triangles(before, int(versions.size()), change, changed, *version);
  versions.push_back(std::move(version));
  return versions;
}

Mat3f gradient_at(const ShapeVersion& version, const Corners& corners, const Hit& hit) {
  if (version.gradients.empty()) return Mat3f::identity();
  Mat3f m{};
  const std::array<float, 3> weight = barycentrics(hit.b1, hit.b2);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i) m.row[i] += version.gradients[corners[c]].row[i] * weight[c];
  // Determinant below which the surface is folded or crushed; offsets from the mesh are then kept as they
  // were.
  constexpr float kFlat = 0.05f;
  return determinant(m) > kFlat ? m : Mat3f::identity();
}

Vec3f mesh_point(const ShapeVersion& version, const Corners& corners, const Hit& hit) {
  return at_corners(version.surface->mesh().positions, corners, hit.b1, hit.b2);
}

// Offsets from the mesh are carried by the gradients, x_k = m_k + F_k F^-1 (x - m), normals by the inverse
// transposes.
SurfacePoint in_version(const ShapeVersions& versions, const Hit& hit, int k) {
  if (versions.empty() || versions.back()->shaped_in(hit.triangle) <= k) return {hit.position, hit.normal};
  const ShapeVersion &now = *versions.back(), &then = *versions[k];
  const Corners& corners = now.surface->mesh().triangles[hit.triangle];
  const Mat3f f = gradient_at(now, corners, hit), g = gradient_at(then, corners, hit);
  const Vec3f offset = inverse(f) * (hit.position - mesh_point(now, corners, hit));
  const Vec3f normal = transpose(f) * hit.normal;
  return {mesh_point(then, corners, hit) + g * offset, normalize(inverse_transpose(g) * normal)};
}

}  // namespace cei3d
