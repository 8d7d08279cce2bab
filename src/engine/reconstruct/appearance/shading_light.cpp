// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/shading_light.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/light_harmonics.h"
#include "engine/reconstruct/appearance/split_irradiance.h"
#include "model/geometry/mesh/adjacency.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kPairs = 300000;
constexpr int kMaxSteps = 24;        // of the walk along edges from one place of a pair to the other
constexpr float kHueSpread = 0.03f;  // by which the channels' shares of the sum differ within one paint
constexpr float kDark = 0.02f;       // of the mean radiance: darker places say little
// Minimum share of the sky that reaches places of pairs, and those whose albedo decides the light's strength:
// what little light reaches cavities is known badly.
constexpr float kOpen = 0.15f, kWideOpen = 0.5f;
constexpr int kRounds = 12;      // of least squares, weighted anew
constexpr float kNoise = 0.02f;  // relative difference that noise explains
constexpr double kSmoothness =
    1e-3;                         // weight of the light's smoothness, relative to the mean of its unknowns
constexpr double kBright = 0.98;  // quantile of the albedo that counts as the brightest
constexpr float kMinRadiance = 0.02f;    // of the light, relative to its mean
constexpr float kMinIrradiance = 1e-3f;  // keeps divisors positive

constexpr int kChunks = 16;  // of pairs; fixed, so that sums are the same on any machine

using Matrix = Eigen::Matrix<double, kHarmonics, kHarmonics>;
using Vector = Eigen::Matrix<double, kHarmonics, 1>;

struct Pair {
  uint32_t a, b;
  float likeness;  // of their hues, (0, 1]
};

float dot(const Harmonics& a, const Harmonics& b) {
  float sum = 0;
  for (size_t j = 0; j < kHarmonics; ++j) sum += a[j] * b[j];
  return sum;
}

float mean_of(Vec3f v) { return (v.x + v.y + v.z) / 3; }

// Share of the sky that reaches a vertex, weighted by the cosine.
float open_share(const Harmonics& transfer) { return transfer[0] / (harmonics({0, 0, 1})[0] * kPi); }

struct Shading {
  std::vector<Harmonics> transfer;  // #V, irradiance from the harmonics of a light
  std::vector<Vec3f> bounce;        // #V, irradiance from the surface
  std::span<const Vec3f> diffuse;   // #V

  Vec3f irradiance(uint32_t v, const Harmonics& light) const {
    Vec3f e = bounce[v];
    for (int c = 0; c < 3; ++c) e[c] = max(e[c] + dot(transfer[v], light), kMinIrradiance);
    return e;
  }
};

uint32_t walk(const VertexLists& near, uint32_t from, Rng& rng) {
  for (int step = int(rng.uniform() * kMaxSteps); step >= 0; --step) {
    const std::span<const uint32_t> next = near.of(from);
    if (next.empty()) break;
    from = next[std::min(size_t(rng.uniform() * float(next.size())), next.size() - 1)];
  }
  return from;
}

// Random places, each with one that a walk along edges leads to and that has about its hue.
std::vector<Pair> pairs_of(const Mesh& mesh, const Shading& s, uint64_t seed) {
  const VertexLists near = joined_by(mesh.positions.size(), edges_of(mesh.triangles));
  const size_t n = s.diffuse.size();
  double mean = 0;
  for (const Vec3f& d : s.diffuse) mean += mean_of(d) / double(n);
  const auto counts = [&](uint32_t v) {
    return mean_of(s.diffuse[v]) >= kDark * mean && open_share(s.transfer[v]) >= kOpen;
  };
  std::vector<Pair> pairs;
  for (int k = 0; k < kPairs; ++k) {
    Rng rng(seed, 0, uint64_t(k));
    const auto a = uint32_t(std::min(size_t(rng.uniform() * float(n)), n - 1)), b = walk(near, a, rng);
    if (a == b || !counts(a) || !counts(b)) continue;
    const Vec3f hue = s.diffuse[a] / (3 * mean_of(s.diffuse[a])) - s.diffuse[b] / (3 * mean_of(s.diffuse[b]));
    const float likeness = std::exp(-cei3d::dot(hue, hue) / (2 * square(kHueSpread)));
    if (likeness > 0.01f) pairs.push_back({a, b, likeness});
  }
  return pairs;
}

struct Equations {
  Matrix matrix = Matrix::Zero();  // the lower half
  Vector right = Vector::Zero();
};

// Two places of one albedo: D_a E_b = D_b E_a. The weights make least squares of these differences a sum of
// absolute relative ones.
void add_pair(const Shading& s, const Pair& pair, const Harmonics& light, Equations& sums) {
  const Vec3f da = s.diffuse[pair.a], db = s.diffuse[pair.b];
  const Vec3f ab = da * s.irradiance(pair.b, light), ba = db * s.irradiance(pair.a, light);
  Vec3f both = ab + ba, difference{};
  for (int c = 0; c < 3; ++c) {
    both[c] = max(both[c], kDark * mean_of(ab + ba));
    difference[c] = abs(ab[c] - ba[c]) / both[c];
  }
  for (int c = 0; c < 3; ++c) {
    const double weight = pair.likeness / (max(mean_of(difference), kNoise) * square(double(both[c])));
    Vector g;
    for (int j = 0; j < int(kHarmonics); ++j)
      g[j] = da[c] * s.transfer[pair.b][size_t(j)] - db[c] * s.transfer[pair.a][size_t(j)];
    sums.matrix.selfadjointView<Eigen::Lower>().rankUpdate(g, weight);
    sums.right -= weight * double(da[c] * s.bounce[pair.b][c] - db[c] * s.bounce[pair.a][c]) * g;
  }
}

Equations equations_at(const Shading& s, const std::vector<Pair>& pairs, const Harmonics& light) {
  std::vector<Equations> parts(kChunks);
  parallel_for(kChunks, [&](int chunk) {
    const size_t n = pairs.size(), begin = n * size_t(chunk) / kChunks, end = n * size_t(chunk + 1) / kChunks;
    for (size_t i = begin; i < end; ++i) add_pair(s, pairs[i], light, parts[size_t(chunk)]);
  });
  Equations all;
  for (const Equations& part : parts) all.matrix += part.matrix, all.right += part.right;
  return all;
}

// The smooth light that solves the equations best among those of a mean irradiance, along . light.
Vector solve(const Equations& e, const Vector& along, double mean) {
  Matrix m = e.matrix.selfadjointView<Eigen::Lower>();
  const double scale = m.diagonal().mean() + 1e-30;
  for (int j = 0; j < int(kHarmonics); ++j) {
    const int band = int(std::sqrt(double(j)));
    m(j, j) += scale * (1e-6 + kSmoothness * square(square(double(band))));
  }
  const Eigen::LDLT<Matrix> factors(m);
  const Vector free = factors.solve(e.right), back = factors.solve(along);
  return free + back * ((mean - along.dot(free)) / along.dot(back));
}

// By what factor the light has to be stronger for the brightest places to have kBrightAlbedo.
float missing_strength(const Shading& s, const std::vector<Pair>& pairs, const Harmonics& light) {
  std::vector<float> albedo;
  for (const Pair& pair : pairs) {
    if (open_share(s.transfer[pair.a]) < kWideOpen) continue;
    const Vec3f a = s.diffuse[pair.a] * kPi / s.irradiance(pair.a, light);
    albedo.push_back(max(a.x, max(a.y, a.z)));
  }
  if (albedo.empty()) return 1;
  const auto rank = size_t(kBright * double(albedo.size() - 1));
  return value_of_rank(std::move(albedo), rank) / kBrightAlbedo;
}

Harmonics solve_light(const Shading& s, const std::vector<Pair>& pairs) {
  Vector along = Vector::Zero(), light = Vector::Zero();
  for (const Pair& pair : pairs)
    for (int j = 0; j < int(kHarmonics); ++j)
      along[j] += s.transfer[pair.a][size_t(j)] / double(pairs.size());
  light[0] = 1;
  Harmonics out{};
  for (int round = 0; round <= kRounds; ++round) {
    for (size_t j = 0; j < kHarmonics; ++j) out[j] = float(light[int(j)]);
    const double mean = along.dot(light) * missing_strength(s, pairs, out);
    if (round < kRounds && !pairs.empty()) light = solve(equations_at(s, pairs, out), along, mean);
  }
  return out;
}

}  // namespace

ShadingLight light_of_shading(const Transport& transport, std::span<const Vec3f> diffuse, int height,
                              uint64_t seed) {
  const Shading s{transfer_of(transport), transport.bounce(diffuse), diffuse};
  const Harmonics light = solve_light(s, pairs_of(transport.surface().mesh(), s, seed));
  const float least = kMinRadiance * light[0] * harmonics({0, 0, 1})[0];
  ShadingLight out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, 2 * height, height);
      out.radiance.push_back(Vec3f{1, 1, 1} * max(dot(harmonics(d), light), least));
    }
  out.irradiance = transport.sky(sky_radiance(light_image(out.radiance, height)));
  for (size_t v = 0; v < out.irradiance.size(); ++v) out.irradiance[v] += s.bounce[v];
  return out;
}

}  // namespace cei3d
