// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/sdf_normals.h"

#include <algorithm>

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

std::vector<Vec3f> difference_gradients(const Device& device, const Field& sdf, std::span<const Vec3f> x,
                                        float step) {
  std::vector<Vec3f> points, out(x.size());
  points.reserve(x.size() * 6);
  for (const Vec3f& p : x) for_each_neighbor(p, step, [&](Vec3f q, int, float) { points.push_back(q); });
  const std::vector<float> d = first_output(device, sdf, points);
  for (size_t i = 0; i < x.size(); ++i)
    out[i] =
        Vec3f{d[6 * i] - d[6 * i + 1], d[6 * i + 2] - d[6 * i + 3], d[6 * i + 4] - d[6 * i + 5]} / (2 * step);
  return out;
}

// Gradients with given weights of the narrow differences, which are computed only where they count.
std::vector<Vec3f> gradients_with(const Device& device, const Field& sdf, std::span<const Vec3f> x,
                                  std::span<const float> edges) {
  const NormalSteps steps = normal_steps(sdf.config());
  std::vector<Vec3f> out = difference_gradients(device, sdf, x, steps.wide), at;
  std::vector<size_t> sharp;
  for (size_t i = 0; i < x.size(); ++i)
    if (edges[i] > 0) sharp.push_back(i), at.push_back(x[i]);
  const std::vector<Vec3f> narrow = difference_gradients(device, sdf, at, steps.narrow);
  for (size_t k = 0; k < sharp.size(); ++k) {
    const float edge = edges[sharp[k]];
    out[sharp[k]] = out[sharp[k]] * (1 - edge) + narrow[k] * edge;
  }
  return out;
}

}  // namespace

NormalSteps normal_steps(const FieldConfig& config) {
  if (config.encoding.levels == 0) return {0.004f, 0.004f};
  const float cell = 2.0f / float(config.encoding.finest_resolution);
  return {kWideCells * cell, kNarrowCells * cell};
}

std::vector<Vec3f> sdf_gradients(const Device& device, const Field& sdf, std::span<const Vec3f> x,
                                 std::span<float> edges) {
  const NormalSteps steps = normal_steps(sdf.config());
  std::vector<Vec3f> out = difference_gradients(device, sdf, x, steps.wide);
  if (steps.narrow == steps.wide) {
    std::fill(edges.begin(), edges.end(), 0.0f);
    return out;
  }
  const std::vector<Vec3f> narrow = difference_gradients(device, sdf, x, steps.narrow);
  for (size_t i = 0; i < x.size(); ++i) {
    const float cosine = dot(normalize(out[i]), normalize(narrow[i]));
    const float t = clamp((kSmooth - cosine) / (kSmooth - kEdge), 0.0f, 1.0f), edge = t * t * (3 - 2 * t);
    out[i] = out[i] * (1 - edge) + narrow[i] * edge;
    if (!edges.empty()) edges[i] = edge;
  }
  return out;
}

std::vector<Vec3f> sdf_gradients_along(const Device& device, const Field& sdf, std::span<const Vec3f> x,
                                       std::span<const Vec3f> directions, std::span<const float> edges) {
  const float step = normal_steps(sdf.config()).wide;
  std::vector<Vec3f> before, behind;
  for (size_t i = 0; i < x.size(); ++i) {
    before.push_back(x[i] - directions[i] * step);
    behind.push_back(x[i] + directions[i] * step);
  }
  std::vector<Vec3f> out = gradients_with(device, sdf, behind, edges);
  const std::vector<Vec3f> first = gradients_with(device, sdf, before, edges);
  for (size_t i = 0; i < x.size(); ++i) out[i] = (out[i] - first[i]) / (2 * step);
  return out;
}

void sdf_normals(const Device& device, const Field& sdf, std::span<const Vec3f> x, std::span<Vec3f> out,
                 std::span<float> edges) {
  const std::vector<Vec3f> gradients = sdf_gradients(device, sdf, x, edges);
  for (size_t i = 0; i < x.size(); ++i) out[i] = normalize(gradients[i]);
}

void add_value_grads(const FieldConfig& config, std::span<const Vec3f> x, std::span<const Vec3f> d_gradients,
                     std::span<const float> edges, std::vector<Vec3f>& points, std::vector<float>& d_values) {
  const NormalSteps steps = normal_steps(config);
  const auto add = [&](size_t i, float share, float step) {
    if (share == 0) return;
    for_each_neighbor(x[i], step, [&](Vec3f q, int axis, float side) {
      points.push_back(q);
      d_values.push_back(share * side * d_gradients[i][axis] / (2 * step));
    });
  };
  for (size_t i = 0; i < x.size(); ++i) {
    add(i, 1 - edges[i], steps.wide);
    add(i, edges[i], steps.narrow);
  }
}

}  // namespace cei3d
