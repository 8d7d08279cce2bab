// SPDX-License-Identifier: Apache-2.0
#include "model/light/refine_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/fibonacci.h"
#include "core/math/sg.h"

namespace cei3d {
namespace {

constexpr int kDirections = 600;
constexpr int kRows = 128;                // rows of the light's image: fine beside the blurs
constexpr float kBlurs[] = {0, 44, 217};  // 0: the cosine of irradiance, else the sharpness of a Gaussian
constexpr double kHold = 1e-3;            // weight of the colors that were there
constexpr int kSweeps = 300;

// A sample of the light: in one direction, through one blur of unit integral.
struct BlurredSample {
  Vec3f direction;
  float blur, unit;  // unit: what makes its integral 1
};
constexpr float kFar = -12;  // logarithm of what is left out of a blur

float through(const BlurredSample& sample, Vec3f light) {
  const float c = dot(sample.direction, light);
  if (sample.blur == 0) return max(c, 0.0f) * sample.unit;
  const float t = sample.blur * (c - 1);
  return t < kFar ? 0 : std::exp(t) * sample.unit;
}
float through(const BlurredSample& sample, const SgLobe& lobe) {
  const Vec3f gap = sample.direction - lobe.axis;
  return sample.unit * (sample.blur > 0
                            ? sg_inner(lobe.lambda, sample.blur, dot(gap, gap))
                            : max(sg_irradiance(lobe.lambda, dot(sample.direction, lobe.axis)), 0.0f));
}

std::vector<BlurredSample> blurred_samples() {
  std::vector<BlurredSample> out;
  for (const float blur : kBlurs)
    for (int i = 0; i < kDirections; ++i)
      out.push_back({fibonacci_direction(i, kDirections), blur, 1 / (blur > 0 ? sg_integral(blur) : kPi)});
  return out;
}

std::vector<Vec3f> seen(const std::vector<BlurredSample>& samples, const Image& map, EnvUp up) {
  std::vector<Vec3f> directions, light;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      directions.push_back(env_direction(float(x) + 0.5f, float(y) + 0.5f, map.width, map.height, up));
      light.push_back(map.rgb(x, y) * env_solid_angle(y, map.width, map.height));
    }
  std::vector<Vec3f> out(samples.size(), Vec3f{0, 0, 0});
  parallel_for(int(samples.size()), [&](int i) {
    for (size_t k = 0; k < directions.size(); ++k)
      out[size_t(i)] += light[k] * through(samples[size_t(i)], directions[k]);
  });
  return out;
}

// |A x - b|^2 + the pull towards what x was, in normal equations: A^T A + diag(pull), A^T b.
struct Normal {
  size_t n;
  std::vector<double> matrix, pull;            // #n * n, #n
  std::vector<std::array<double, 3>> product;  // #n, a channel each

  Normal(const std::vector<BlurredSample>& samples, const std::vector<Vec3f>& wanted, const SgMixture& light)
      : n(light.lobes.size()), matrix(n * n, 0.0), pull(n), product(n, {0, 0, 0}) {
    std::vector<float> row(n);
    for (size_t i = 0; i < samples.size(); ++i) {
      for (size_t k = 0; k < n; ++k) row[k] = through(samples[i], light.lobes[k]);
      for (size_t j = 0; j < n; ++j) {
        for (size_t k = 0; k < n; ++k) matrix[j * n + k] += double(row[j]) * row[k];
        for (int c = 0; c < 3; ++c) product[j][size_t(c)] += double(row[j]) * wanted[i][c];
      }
    }
    for (size_t j = 0; j < n; ++j) pull[j] = kHold * matrix[j * n + j];
  }
};

// Coordinate descent with x >= 0, from the colors that were there.
void solve(const Normal& a, int channel, SgMixture& light) {
  const auto color = [&](size_t j) -> float& { return light.lobes[j].mu[channel]; };
  std::vector<double> was;
  for (size_t j = 0; j < a.n; ++j) was.push_back(color(j));
  std::vector<double> x = was;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (size_t j = 0; j < a.n; ++j) {
      double rest = a.product[j][size_t(channel)] + a.pull[j] * (was[j] - x[j]);
      for (size_t k = 0; k < a.n; ++k) rest -= a.matrix[j * a.n + k] * x[k];
      const double diagonal = a.matrix[j * a.n + j] + a.pull[j];
      if (diagonal > 0) x[j] = std::max(x[j] + rest / diagonal, 0.0);
    }
  for (size_t j = 0; j < a.n; ++j) color(j) = float(x[j]);
}

}  // namespace

SgMixture refine_colors(SgMixture light, const Image& lat_long, EnvUp up) {
  const Image map = env_resample(lat_long, kRows);
  const std::vector<BlurredSample> samples = blurred_samples();
  const Normal normal(samples, seen(samples, map, up), light);
  for (int c = 0; c < 3; ++c) solve(normal, c, light);
  return light;
}

}  // namespace cei3d
