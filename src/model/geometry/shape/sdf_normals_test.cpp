// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/sdf_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace cei3d {
namespace {

Device device() { return make_device("cpu"); }

FieldConfig grid_field() {
  FieldConfig c;
  c.encoding.levels = 8;
  c.encoding.finest_resolution = 48;
  c.width = 32;
  c.activation = Activation::softplus;
  c.outputs = 1;
  c.sphere_radius = 0.5f;
  return c;
}

float degrees(Vec3f a, Vec3f b) { return std::acos(clamp(dot(a, b), -1.0f, 1.0f)) * 180 / kPi; }

// Two planes that meet at a right angle along the x axis: material below both, z < -|y|.
float roof(Vec3f p) { return (p.z + std::abs(p.y)) / std::sqrt(2.0f); }
Vec3f roof_normal(Vec3f p) { return normalize(Vec3f{0, p.y > 0 ? 1.0f : -1.0f, 1}); }

constexpr int kSteps = 600;

Field fitted_roof(const Device& device) {
  Field field(grid_field(), 1);
  FieldTrainer trainer(field, {});
  for (int step = 0; step < kSteps; ++step) {
    std::vector<Vec3f> x(4096);
    for (size_t i = 0; i < x.size(); ++i) {
      Rng rng(3, uint64_t(step), i);
      const float y = 0.9f * (rng.uniform() - 0.5f);
      x[i] = {0.9f * (rng.uniform() - 0.5f), y, -std::abs(y) + 0.3f * (rng.uniform() - 0.5f)};
    }
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i)
        d_out[i - begin] = 2 * (out[i - begin] - roof(x[i])) / float(x.size());
    };
    trainer.step(device, x, loss, std::pow(0.01f, float(step) / kSteps));
  }
  return field;
}

// Mean angle to the truth, of points of the roof at `cells` finest cells from its edge.
double error_at(const Device& device, const Field& field, float cells, std::vector<float>& edges) {
  const float y = cells * 2 / float(field.config().encoding.finest_resolution);
  std::vector<Vec3f> x, n(200);
  for (int i = 0; i < 200; ++i) x.push_back({0.5f * (float(i) / 200 - 0.5f), i % 2 ? y : -y, -y});
  edges.resize(x.size());
  sdf_normals(device, field, x, n, edges);
  double sum = 0;
  for (size_t i = 0; i < x.size(); ++i) sum += degrees(n[i], roof_normal(x[i]));
  return sum / double(x.size());
}

TEST(SdfNormals, AreSharpAtAnEdgeAndSmoothBesideIt) {
  const Device d = device();
  const Field field = fitted_roof(d);
  std::vector<float> edges;
  // Differences of three cells alone are wrong by 18 degrees here: one of their six points is beyond the edge
  // by two thirds of the way.
  EXPECT_LT(error_at(d, field, 1.5f, edges), 6);
  for (const float e : edges) EXPECT_GT(e, 0.9f);
  EXPECT_LT(error_at(d, field, 5, edges), 1.5);
  float mean = 0;
  for (const float e : edges) mean += e / float(edges.size());
  EXPECT_LT(mean, 0.2f);
}

TEST(SdfNormals, AdjointTellsWhatAChangeOfTheFieldDoesToALoss) {
  const Device d = device();
  const Field field = fitted_roof(d);
  Field moved = field;
  for (auto& p : moved.params().all())
    if (p.name == "layer1/weight")
      for (size_t i = 0; i < p.value.size(); ++i) p.value[i] += 1e-3f * std::sin(float(i));
  std::vector<Vec3f> x, slopes, n(300), n_moved(300), points;
  for (int i = 0; i < 300; ++i) {
    const float y = 0.3f * (float(i) / 300 - 0.5f);
    x.push_back({0.1f, y, -std::abs(y)});
  }
  std::vector<float> edges(300), edges_moved(300), d_values;
  sdf_normals(d, field, x, n, edges);
  sdf_normals(d, moved, x, n_moved, edges_moved);
  double change = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3f along = normalize(cross(n[i], Vec3f{1, 0.2f, 0.1f}));
    // Right where the edge is weighed as before.
    slopes.push_back(edges[i] == edges_moved[i] ? along : Vec3f{0, 0, 0});
    change += dot(slopes[i], n_moved[i] - n[i]);
  }
  add_value_grads(field.config(), x, slopes, edges, points, d_values);
  const std::vector<float> before = first_output(d, field, points), after = first_output(d, moved, points);
  double predicted = 0;
  for (size_t i = 0; i < points.size(); ++i) predicted += double(d_values[i]) * (after[i] - before[i]);
  EXPECT_GT(std::abs(change), 1e-3);
  EXPECT_NEAR(predicted, change, 0.1 * std::abs(change));
}

TEST(SdfNormals, OneWidthWithoutAGrid) {
  FieldConfig c;
  c.encoding.frequencies = 4;
  const NormalSteps s = normal_steps(c);
  EXPECT_EQ(s.wide, s.narrow);
}

}  // namespace
}  // namespace cei3d
