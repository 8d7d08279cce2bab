// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {
namespace {

constexpr float kWideCells = 3, kNarrowCells = 1;    // steps in cells of the finest hash level
constexpr float kSmooth = 0.9994f, kEdge = 0.9945f;  // cosines of 2 and 6 degrees between the two normals

// Calls use(point, axis, side) for the six points p +- step along the axes.
template <class Use>
void for_each_neighbor(Vec3f p, float step, const Use& use) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.0f, -1.0f}) {
      Vec3f q = p;
      q[axis] += side * step;
      use(q, axis, side);
    }
}

std::vector<Vec3f> difference_normals(const Device& device, const Field& sdf, std::span<const Vec3f> x,
                                      float step) {
  std::vector<Vec3f> points, out(x.size());
  points.reserve(x.size() * 6);
  for (const Vec3f& p : x) for_each_neighbor(p, step, [&](Vec3f q, int, float) { points.push_back(q); });
  const std::vector<float> d = first_output(device, sdf, points);
  for (size_t i = 0; i < x.size(); ++i)
    out[i] =
        normalize(Vec3f{d[6 * i] - d[6 * i + 1], d[6 * i + 2] - d[6 * i + 3], d[6 * i + 4] - d[6 * i + 5]});
  return out;
}

}  // namespace

NormalSteps normal_steps(const FieldConfig& config) {
  if (config.encoding.levels == 0) return {0.004f, 0.004f};
  const float cell = 2.0f / float(config.encoding.finest_resolution);
  return {kWideCells * cell, kNarrowCells * cell};
}

void sdf_normals(const Device& device, const Field& sdf, std::span<const Vec3f> x, std::span<Vec3f> out,
                 std::span<float> edges) {
  const NormalSteps steps = normal_steps(sdf.config());
  const std::vector<Vec3f> wide = difference_normals(device, sdf, x, steps.wide);
  const std::vector<Vec3f> narrow =
      steps.narrow == steps.wide ? wide : difference_normals(device, sdf, x, steps.narrow);
  for (size_t i = 0; i < x.size(); ++i) {
    const float t = clamp((kSmooth - dot(wide[i], narrow[i])) / (kSmooth - kEdge), 0.0f, 1.0f);
    const float edge = t * t * (3 - 2 * t);
    out[i] = normalize(wide[i] * (1 - edge) + narrow[i] * edge);
    if (!edges.empty()) edges[i] = edge;
  }
}

void add_value_slopes(const FieldConfig& config, std::span<const Vec3f> x, std::span<const Vec3f> d_normals,
                      std::span<const float> edges, std::vector<Vec3f>& points,
                      std::vector<float>& d_values) {
  const NormalSteps steps = normal_steps(config);
  const auto add = [&](size_t i, float share, float step) {
    if (share == 0) return;
    for_each_neighbor(x[i], step, [&](Vec3f q, int axis, float side) {
      points.push_back(q);
      d_values.push_back(share * side * d_normals[i][axis] / (2 * step));
    });
  };
  for (size_t i = 0; i < x.size(); ++i) {
    add(i, 1 - edges[i], steps.wide);
    add(i, edges[i], steps.narrow);
  }
}

}  // namespace cei3d
