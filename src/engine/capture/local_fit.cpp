// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/local_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/math/quantile.h"

namespace cei3d {
namespace {

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

constexpr size_t kNearest = 10;
constexpr double kSmall = 0.05;  // differences up to here count by their square, larger ones by their size
constexpr double kSlope = 0.15;  // prior: one direction of this weight says that the value does not change
constexpr int kReweightings = 6;

struct Neighbor {
  Vector4 position;  // 1, and the step from the direction that is judged
  double value = 0;
  double weight = 0;  // by nearness
};

std::vector<Neighbor> neighbors_of(std::span<const Vec3d> directions, std::span<const double> values,
                                   size_t i) {
  std::vector<std::pair<double, size_t>> all;
  for (size_t k = 0; k < directions.size(); ++k)
    if (k != i) all.push_back({length(directions[k] - directions[i]), k});
  const size_t n = std::min(kNearest, all.size());
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(n), all.end());
  all.resize(n);
  std::vector<double> distances;
  for (const auto& [distance, k] : all) distances.push_back(distance);
  const double usual = std::max(median(distances), 1e-6);
  std::vector<Neighbor> out;
  for (const auto& [distance, k] : all) {
    const Vec3d step = directions[k] - directions[i];
    out.push_back({{1, step.x, step.y, step.z}, values[k], std::exp(-square(distance / usual))});
  }
  return out;
}

// Normal equations of the weighted squares, for a function's value at the judged direction and its slopes.
Matrix4 normal_matrix(const std::vector<Neighbor>& neighbors, const std::vector<double>& weights) {
  Matrix4 m = Matrix4::Zero();
  for (size_t k = 0; k < neighbors.size(); ++k)
    m += weights[k] * neighbors[k].position * neighbors[k].position.transpose();
  for (int c = 1; c < 4; ++c) m(c, c) += square(kSlope);
  return m;
}

double judged(const std::vector<Neighbor>& neighbors, double value) {
  std::vector<double> nearness;
  for (const Neighbor& n : neighbors) nearness.push_back(n.weight);
  std::vector<double> weights = nearness;
  Vector4 fit = Vector4::Zero();
  for (int round = 0; round < kReweightings; ++round) {
    Vector4 right = Vector4::Zero();
    for (size_t k = 0; k < neighbors.size(); ++k)
      right += weights[k] * neighbors[k].value * neighbors[k].position;
    fit = normal_matrix(neighbors, weights).ldlt().solve(right);
    for (size_t k = 0; k < neighbors.size(); ++k) {
      const double off = std::abs(neighbors[k].value - neighbors[k].position.dot(fit));
      weights[k] = nearness[k] * std::min(1.0, kSmall / std::max(off, 1e-9));
    }
  }
  const double variance = normal_matrix(neighbors, nearness).ldlt().solve(Vector4(Vector4::UnitX()))(0);
  return (value - fit(0)) / std::sqrt(1 + variance);
}

}  // namespace

std::vector<double> against_nearby(std::span<const Vec3d> directions, std::span<const double> values) {
  std::vector<double> out(values.size(), 0);
  if (values.size() < 4) return out;
  for (size_t i = 0; i < values.size(); ++i) out[i] = judged(neighbors_of(directions, values, i), values[i]);
  return out;
}

}  // namespace cei3d
