// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/shading_light.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "core/math/rng.h"
#include "model/geometry/mesh/adjacency.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kPairs = 60000;
constexpr int kMaxSteps = 24;        // maximum number of edges from one place of a pair to the other
constexpr float kHueSpread = 0.03f;  // by which the channels' shares of the sum differ within one paint
constexpr float kDark = 0.02f;  // radiance of dark places, which say little, relative to the mean radiance
// Minimum share of the sky that reaches places of pairs, and those whose albedo decides the light's strength:
// what little light reaches cavities is known badly.
constexpr float kOpen = 0.15f, kWideOpen = 0.5f;
constexpr int kRounds = 8;       // rounds of least squares, each weighted by the last
constexpr float kNoise = 0.02f;  // relative difference that noise explains
// Weights of the light's smoothness and of its change in a round, relative to the mean of its directions.
constexpr float kSmoothness = 1e-3f, kDamping = 1e-2f;
constexpr float kMeanWeight = 100;  // weight of the light's mean irradiance, which the pairs do not determine
constexpr int kSweeps = 300;        // over the directions, of the solution of a round
constexpr double kBright = 0.98;    // quantile of the albedo that counts as the brightest
constexpr float kMinRadiance = 0.01f;    // minimum radiance of the light, relative to its mean
constexpr float kMinIrradiance = 1e-3f;  // keeps divisors positive

constexpr int kChunks = 16;     // chunks of pairs; fixed, so that sums are the same on any machine
constexpr size_t kBlock = 256;  // pairs of a chunk at a time

using Matrix = Eigen::MatrixXf;
using Vector = Eigen::VectorXf;

struct Pair {
  uint32_t a, b;
  float likeness;  // of their hues, (0, 1]
};

float mean_of(Vec3f v) { return (v.x + v.y + v.z) / 3; }

struct Shading {
  const Surface& surface;
  std::span<const Vec3f> diffuse;  // #V
  std::vector<Vec3f> bounce;       // #V, irradiance from the surface

  // Irradiance of a vertex by light of radiance 1 from each of sky_directions(). out: #kSkyDirections.
  void transfer(uint32_t v, Eigen::Ref<Vector> out) const {
    const std::vector<Vec3f>& sky = sky_directions();
    for (int k = 0; k < kSkyDirections; ++k) {
      const float cosine = dot(surface.mesh().normals[v], sky[size_t(k)]);
      out[k] = cosine > 0 && surface.sees(v, k) ? cosine * (4 * kPi / kSkyDirections) : 0;
    }
  }
  // Share of the sky that reaches a vertex, weighted by the cosine.
  float open_share(uint32_t v) const {
    Vector t(kSkyDirections);
    transfer(v, t);
    return t.sum() / kPi;
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
std::vector<Pair> pairs_of(const Shading& s, uint64_t seed) {
  const Mesh& mesh = s.surface.mesh();
  const VertexLists near = joined_by(mesh.positions.size(), edges_of(mesh.triangles));
  const size_t n = s.diffuse.size();
  double mean = 0;
  for (const Vec3f& d : s.diffuse) mean += mean_of(d) / double(n);
  const auto counts = [&](uint32_t v) {
    return mean_of(s.diffuse[v]) >= kDark * mean && s.open_share(v) >= kOpen;
  };
  std::vector<Pair> pairs;
  for (int k = 0; k < kPairs; ++k) {
    Rng rng(seed, 0, uint64_t(k));
    const auto a = uint32_t(std::min(size_t(rng.uniform() * float(n)), n - 1)), b = walk(near, a, rng);
    if (a == b || !counts(a) || !counts(b)) continue;
    const Vec3f hue = s.diffuse[a] / (3 * mean_of(s.diffuse[a])) - s.diffuse[b] / (3 * mean_of(s.diffuse[b]));
    const float likeness = std::exp(-dot(hue, hue) / (2 * square(kHueSpread)));
    if (likeness > 0.01f) pairs.push_back({a, b, likeness});
  }
  return pairs;
}

struct Equations {
  Matrix matrix = Matrix::Zero(kSkyDirections, kSkyDirections);  // the lower half
  Vector right = Vector::Zero(kSkyDirections);
};

// Two places of one albedo: log(E_a / E_b) = log(D_a / D_b), linear about the present light. The weights make
// least squares of the differences a sum of absolute ones.
void add_pairs(const Shading& s, std::span<const Pair> pairs, const Vector& light, Equations& sums) {
  Matrix rows(kSkyDirections, Eigen::Index(pairs.size()));
  Vector right(rows.cols()), a(kSkyDirections), b(kSkyDirections);
  for (Eigen::Index i = 0; i < rows.cols(); ++i) {
    const Pair& pair = pairs[size_t(i)];
    s.transfer(pair.a, a);
    s.transfer(pair.b, b);
    const float of_a = a.dot(light), of_b = b.dot(light),
                all_a = max(of_a + mean_of(s.bounce[pair.a]), kMinIrradiance),
                all_b = max(of_b + mean_of(s.bounce[pair.b]), kMinIrradiance);
    const float difference =
        std::log(all_a / all_b * (mean_of(s.diffuse[pair.b]) / mean_of(s.diffuse[pair.a])));
    const float weight = std::sqrt(pair.likeness / max(abs(difference), kNoise));
    rows.col(i) = (a / all_a - b / all_b) * weight;
    right[i] = (of_a / all_a - of_b / all_b - difference) * weight;
  }
  sums.matrix.selfadjointView<Eigen::Lower>().rankUpdate(rows);
  sums.right += rows * right;
}

Equations equations_at(const Shading& s, std::span<const Pair> pairs, const Vector& light) {
  std::vector<Equations> parts(kChunks);
  parallel_for(kChunks, [&](int chunk) {
    const size_t n = pairs.size(), end = n * size_t(chunk + 1) / kChunks;
    for (size_t i = n * size_t(chunk) / kChunks; i < end; i += kBlock)
      add_pairs(s, pairs.subspan(i, std::min(kBlock, end - i)), light, parts[size_t(chunk)]);
  });
  Equations all;
  for (const Equations& part : parts) all.matrix += part.matrix, all.right += part.right;
  all.matrix = Matrix(all.matrix.selfadjointView<Eigen::Lower>());
  return all;
}

// What the pairs leave open: the light is smooth, changes little in a round, and keeps its mean irradiance,
// along . light.
void regularize(Equations& e, const Vector& light, const Vector& along) {
  const float scale = e.matrix.diagonal().mean() + 1e-30f, smoothness = scale * kSmoothness;
  for (int k = 0; k < kSkyDirections; ++k)
    for (const uint16_t near : sky_around(sky_directions()[size_t(k)])) {
      if (near == k) continue;
      e.matrix(k, k) += smoothness;
      e.matrix(near, near) += smoothness;
      e.matrix(k, near) -= smoothness;
      e.matrix(near, k) -= smoothness;
    }
  e.matrix.diagonal().array() += scale * kDamping;
  e.right += scale * kDamping * light;
  const float weight = kMeanWeight * scale / along.squaredNorm();
  e.matrix += weight * along * along.transpose();
  e.right += weight * along.dot(light) * along;
}

// Least squares by coordinate descent, no radiance below zero.
Vector solve(const Equations& e, Vector light) {
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int k = 0; k < kSkyDirections; ++k)
      light[k] = max(light[k] - (e.matrix.col(k).dot(light) - e.right[k]) / e.matrix(k, k), 0.0f);
  return light;
}

// By what factor the light has to be stronger for the brightest places to have kBrightAlbedo.
float missing_strength(const Shading& s, std::span<const Pair> pairs, const Vector& light) {
  std::vector<float> albedo;
  Vector t(kSkyDirections);
  for (const Pair& pair : pairs) {
    s.transfer(pair.a, t);
    if (t.sum() / kPi < kWideOpen) continue;
    const float sky = t.dot(light);
    float largest = 0;
    for (int c = 0; c < 3; ++c)
      largest = max(largest, s.diffuse[pair.a][c] * kPi / max(sky + s.bounce[pair.a][c], kMinIrradiance));
    albedo.push_back(largest);
  }
  if (albedo.empty()) return 1;
  const auto rank = size_t(kBright * double(albedo.size() - 1));
  return value_of_rank(std::move(albedo), rank) / kBrightAlbedo;
}

// Begins with even light.
Vector solve_light(const Shading& s, const std::vector<Pair>& pairs) {
  Vector along = Vector::Zero(kSkyDirections), t(kSkyDirections);
  if (pairs.empty()) return Vector::Ones(kSkyDirections);
  float mean = 0;
  for (const Pair& pair : pairs) {
    s.transfer(pair.a, t);
    along += t / float(pairs.size());
    mean += mean_of(s.diffuse[pair.a]) / float(pairs.size());
  }
  Vector light = Vector::Constant(kSkyDirections, mean);
  for (int round = 0; round < kRounds; ++round) {
    light *= missing_strength(s, pairs, light);
    Equations e = equations_at(s, pairs, light);
    regularize(e, light, along);
    light = solve(e, std::move(light));
  }
  return light * missing_strength(s, pairs, light);
}

}  // namespace

ShadingLight light_of_shading(const Transport& transport, std::span<const Vec3f> diffuse, uint64_t seed) {
  const Shading s{transport.surface(), diffuse, transport.bounce(diffuse)};
  const Vector light = solve_light(s, pairs_of(s, seed));
  const float min_radiance = kMinRadiance * light.mean();
  ShadingLight out;
  for (const float l : light) out.sky.push_back(Vec3f{1, 1, 1} * max(l, min_radiance));
  out.irradiance = transport.sky(out.sky);
  for (size_t v = 0; v < out.irradiance.size(); ++v) out.irradiance[v] += s.bounce[v];
  return out;
}

std::vector<Vec3f> grid_of_sky(const SkyRadiance& sky, int height) {
  std::vector<Vec3f> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      Vec3f sum{0, 0, 0};
      for (const uint16_t k : sky_around(env_direction(float(x) + 0.5f, float(y) + 0.5f, 2 * height, height)))
        sum += sky[k] / 4.0f;
      out.push_back(sum);
    }
  return out;
}

}  // namespace cei3d
