// SPDX-License-Identifier: Apache-2.0
// Kernels of light and shading: every device against the scalar one, adjoints against differences of the
// forward pass.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/compute/test_kernels.h"

namespace cei3d {
namespace {

constexpr int kPoints = 64, kLobes = 32;

std::vector<float> directions(int n, uint64_t seed) {  // [3][n]
  std::vector<float> v(3 * size_t(n));
  for (int i = 0; i < n; ++i) {
    Rng rng(seed, 1, uint64_t(i));
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    for (int c = 0; c < 3; ++c) v[size_t(c) * n + i] = d[c];
  }
  return v;
}

// Unit vectors at right angles to the given ones, whose rows hold kPoints each.
std::vector<float> normal_to(const std::vector<float>& directions) {
  std::vector<float> out(directions.size());
  for (int i = 0; i < kPoints; ++i) {
    const Vec3f side =
        normalize(cross(load_planes<float>(directions.data(), kPoints, i), {0.3f, 0.5f, 0.8f}));
    store_planes(out.data(), kPoints, i, side);
  }
  return out;
}

struct LobeScene {
  std::vector<float> lobes = directions(kLobes, 1), normals = directions(kPoints, 2),
                     mirrors = directions(kPoints, 3);
  // Weights of the outputs in the loss.
  std::vector<float> y1 = noise(3 * kPoints, 4), y2 = noise(3 * kPoints, 5);
  std::vector<float> across = normal_to(mirrors), roughness, stretch;
  LobeScene() {
    for (int k = 0; k < kLobes; ++k) lobes.push_back(0.5f + 80 * square(Rng(6, 0, k).uniform()));
    for (int k = 0; k < 3 * kLobes; ++k) lobes.push_back(Rng(7, 0, k).uniform());
    for (int i = 0; i < kPoints; ++i) {
      roughness.push_back(0.2f + 0.7f * Rng(8, 0, i).uniform());
      stretch.push_back(1 + 1.5f * Rng(11, 0, i).uniform());
    }
  }
  LobePlanes planes() const { return {lobes.data(), kLobes, kLobes}; }
  ReflectionPlanes points() const {
    return {mirrors.data(), across.data(), normals.data(), roughness.data(), stretch.data()};
  }

  std::vector<float> irradiance(const Device& d) const {
    std::vector<float> out(3 * kPoints);
    d.launch<SgIrradiance>({planes(), kPoints, normals.data(), out.data()}, kPoints);
    return out;
  }
  // Leaves out points that get no light: there the forward pass clamps at zero, but the adjoint does not.
  void leave_out_dark_points(const Device& d) {
    const std::vector<float> e = irradiance(d);
    for (size_t i = 0; i < e.size(); ++i)
      if (e[i] <= 0) y1[i] = 0;
  }
  std::vector<float> reflection(const Device& d) const {
    std::vector<float> out(3 * kPoints);
    d.launch<SgReflection>({planes(), kPoints, points(), out.data()}, kPoints);
    return out;
  }
  std::vector<float> reflection_lobes(const Device& d) const {
    std::vector<float> out(ReflectionLobes::kRows * kPoints);
    d.launch<ReflectionLobes>({kPoints, roughness.data(), stretch.data(), out.data()}, kPoints);
    return out;
  }
  std::vector<float> gradient(const Device& d) const {
    std::vector<float> out(7 * kLobes);
    const std::vector<float> reflection = reflection_lobes(d);
    d.launch<SgLobesGrad>({.lobes = planes(),
                           .stride = kPoints,
                           .begin = 0,
                           .end = kPoints,
                           .normals = normals.data(),
                           .axes = mirrors.data(),
                           .across = across.data(),
                           .reflection_lobes = reflection.data(),
                           .d_irradiance = y1.data(),
                           .d_reflected = y2.data(),
                           .d_lobes = out.data()},
                          kLobes);
    return out;
  }
  // [11][kPoints]: by axis, direction across, roughness, stretch and normal.
  std::vector<float> point_gradient(const Device& d) const {
    std::vector<float> out(11 * kPoints);
    d.launch<SgReflectionGrad>({.lobes = planes(),
                                .stride = kPoints,
                                .points = points(),
                                .d_reflected = y2.data(),
                                .d_axes = out.data(),
                                .d_across = out.data() + 3 * kPoints,
                                .d_normals = out.data() + 8 * kPoints,
                                .d_roughness = out.data() + 6 * kPoints,
                                .d_stretch = out.data() + 7 * kPoints},
                               kPoints);
    return out;
  }
  double loss(const Device& d) const {
    const auto e = irradiance(d), p = reflection(d);
    double sum = 0;
    for (size_t i = 0; i < e.size(); ++i) sum += double(y1[i]) * e[i] + double(y2[i]) * p[i];
    return sum;
  }
};

std::vector<float> fit_case(const Device& d, bool gather) {
  LobeScene s;
  std::vector<float> roots = noise(3 * kPoints, 8), weights(kPoints, 0.1f),
                     d_radiance = noise(3 * kPoints, 9);
  std::vector<float> d_lobes(7 * kLobes);
  const SgFitArgs a{s.planes(),     kPoints,           s.normals.data(), roots.data(),
                    weights.data(), d_radiance.data(), d_lobes.data()};
  gather ? d.launch<SgFitGather>(a, kLobes) : d.launch<SgFitResidual>(a, kPoints);
  return gather ? d_lobes : d_radiance;
}

std::vector<float> shading_points() {
  std::vector<float> p = noise(ShadingRows::kRows * kPoints, 10);
  for (float& x : p) x = 0.5f + 0.49f * x;
  return p;
}
// In memory that a card can reach, too.
std::vector<float> split_sum_copy() {
  return {split_sum_table(), split_sum_table() + std::tuple_size_v<PairTable>};
}
std::vector<float> shade_case(const Device& d) {
  const std::vector<float> points = shading_points(), table = split_sum_copy();
  std::vector<float> out(Shade::kOutputs * kPoints);
  d.launch<Shade>({table.data(), kPoints, points.data(), out.data()}, kPoints);
  return out;
}
std::vector<float> shade_grad_case(const Device& d) {
  const std::vector<float> points = shading_points(), y1 = noise(3 * kPoints, 11),
                           y2 = noise(3 * kPoints, 12), table = split_sum_copy();
  std::vector<float> out(points.size());
  d.launch<ShadeGrad>({table.data(), kPoints, points.data(), y1.data(), y2.data(), out.data()}, kPoints);
  return out;
}

// Reflection by one Gaussian; some of the points are seen from behind.
enum class Mirror { forward, points, lobes };
std::vector<float> mirror_case(const Device& d, Mirror which) {
  const LobeScene s;
  std::vector<float> views = directions(kPoints, 12), out(7 * kPoints);
  for (int i = 0; i < kPoints; ++i)
    if (i % 16) {
      const Vec3f n = load_planes<float>(s.normals.data(), kPoints, i);
      store_planes(views.data(), kPoints, i,
                   normalize(load_planes<float>(views.data(), kPoints, i) + n * 1.2f));
    }
  const MirrorPlanes points{kPoints, s.normals.data(), views.data(), 60};
  float *first = out.data(), *second = out.data() + 3 * kPoints;
  if (which == Mirror::forward) d.launch<SgMirror>({s.planes(), points, first, second}, kPoints);
  if (which == Mirror::points)
    d.launch<SgMirrorGrad>({s.planes(), points, s.y1.data(), s.y2.data(), first, second}, kPoints);
  if (which == Mirror::lobes)
    d.launch<SgMirrorLobesGrad>({s.planes(), points, 0, kPoints, s.y1.data(), s.y2.data(), first}, kLobes);
  return out;
}

TEST(ShadeKernels, EveryDeviceAgreesWithTheScalarOne) {
  const std::vector<Case> cases = {
      {"irradiance", [](const Device& d) { return LobeScene().irradiance(d); }},
      {"reflection", [](const Device& d) { return LobeScene().reflection(d); }},
      {"gradient", [](const Device& d) { return LobeScene().gradient(d); }},
      {"reflection lobes", [](const Device& d) { return LobeScene().reflection_lobes(d); }},
      {"gradient of points", [](const Device& d) { return LobeScene().point_gradient(d); }},
      {"shade", [](const Device& d) { return shade_case(d); }},
      {"shade gradient", [](const Device& d) { return shade_grad_case(d); }},
      {"fit residual", [](const Device& d) { return fit_case(d, false); }},
      {"fit gather", [](const Device& d) { return fit_case(d, true); }},
      {"mirror", [](const Device& d) { return mirror_case(d, Mirror::forward); }},
      {"mirror gradient of points", [](const Device& d) { return mirror_case(d, Mirror::points); }},
      {"mirror gradient of lobes", [](const Device& d) { return mirror_case(d, Mirror::lobes); }},
  };
  EXPECT_EQ(never_launched(ShadeKernels{}, cases), "");
  // Irradiance is a difference of numbers 32 times larger, hence not 1e-5.
  for (const Case& c : cases) expect_parity(c, 1e-4);
}

// Vector k of three rows of `count` numbers.
Vec3f vector_at(const std::vector<float>& rows, size_t count, size_t k) {
  return {rows[k], rows[count + k], rows[2 * count + k]};
}

// Checks the derivative of the loss by unit vector k of some rows of the scene against moving that vector
// along the sphere.
void expect_slope_along_the_sphere(const LobeScene& scene, std::vector<float> LobeScene::*rows, size_t count,
                                   size_t k, Vec3f gradient, double tolerance) {
  const Vec3f a = vector_at(scene.*rows, count, k), t = normalize(cross(a, Vec3f{0.3f, 0.5f, 0.8f}));
  const Device device = make_device("cpu/scalar");
  const auto loss_at = [&](float h) {
    LobeScene moved = scene;
    const Vec3f b = normalize(a + t * h);
    for (int c = 0; c < 3; ++c) (moved.*rows)[size_t(c) * count + k] = b[c];
    return moved.loss(device);
  };
  const double slope = (loss_at(0.005f) - loss_at(-0.005f)) / 0.01;
  EXPECT_NEAR(dot(gradient, t), slope, 0.02 * std::abs(slope) + tolerance) << k;
}

TEST(ShadeKernels, AdjointEqualsDifferencesOfTheForwardPass) {
  const Device device = make_device("cpu/scalar");
  LobeScene s;
  s.leave_out_dark_points(device);
  const std::vector<float> g = s.gradient(device);
  for (const int row : {3, 4, 5, 6})  // axes: next test
    for (const int k : {0, 7, 31}) {
      const size_t at = size_t(row) * kLobes + k;
      const float x = s.lobes[at], h = 0.01f * std::max(0.1f, std::abs(x));
      s.lobes[at] = x + h;
      const double up = s.loss(device);
      s.lobes[at] = x - h;
      const double down = s.loss(device);
      s.lobes[at] = x;
      const double slope = (up - down) / (2 * double(h));

      EXPECT_NEAR(g[at], slope, 0.02 * std::abs(slope) + 0.02) << row << ' ' << k;
    }
}

// The lobes of the scene against square roots of radiance on some cells, and the loss that the kernels
// descend, in double precision.
struct LobeFit {
  LobeScene scene;
  std::vector<float> roots = noise(3 * kPoints, 8), weights = noise(kPoints, 12);

  LobeFit() {
    for (float& r : roots) r = std::abs(r);
    for (float& w : weights) w = 0.1f + std::abs(w);
  }
  std::vector<float> gradient(const Device& d) const {
    std::vector<float> d_radiance(3 * kPoints), d_lobes(7 * kLobes);
    const SgFitArgs a{scene.planes(), kPoints,           scene.normals.data(), roots.data(),
                      weights.data(), d_radiance.data(), d_lobes.data()};
    d.launch<SgFitResidual>(a, kPoints);
    d.launch<SgFitGather>(a, kLobes);
    return d_lobes;
  }
  double radiance(int cell, int channel) const {
    const auto lobe = [&](int row, int k) { return double(scene.lobes[size_t(row) * kLobes + size_t(k)]); };
    double sum = 0;
    for (int k = 0; k < kLobes; ++k) {
      double cosine = 0;
      for (int c = 0; c < 3; ++c) cosine += double(scene.normals[size_t(c * kPoints + cell)]) * lobe(c, k);
      sum += lobe(4 + channel, k) * std::exp(lobe(3, k) * (cosine - 1));
    }
    return sum;
  }
  double loss() const {
    double sum = 0;
    for (int i = 0; i < kPoints; ++i)
      for (int c = 0; c < 3; ++c)
        sum += double(weights[size_t(i)]) *
               square(std::sqrt(radiance(i, c) + 1e-4) - double(roots[size_t(c * kPoints + i)]));
    return sum;
  }
};

TEST(ShadeKernels, GradientOfTheFitOfLobesEqualsDifferencesOfItsLoss) {
  LobeFit fit;
  const std::vector<float> g = fit.gradient(make_device("cpu/scalar"));
  for (int row = 0; row < 7; ++row)
    for (const int k : {0, 7, 31}) {
      const size_t at = size_t(row) * kLobes + size_t(k);
      const float x = fit.scene.lobes[at], h = 1e-3f * std::max(0.1f, std::abs(x));
      fit.scene.lobes[at] = x + h;
      const double up = fit.loss(), width = double(fit.scene.lobes[at]);
      fit.scene.lobes[at] = x - h;
      const double slope = (up - fit.loss()) / (width - double(fit.scene.lobes[at]));
      fit.scene.lobes[at] = x;
      EXPECT_NEAR(g[at], slope, 3e-3 * std::abs(slope) + 1e-3) << row << ' ' << k;
    }
}

TEST(ShadeKernels, AdjointOfAnAxisEqualsDifferencesAlongTheSphere) {
  const Device device = make_device("cpu/scalar");
  LobeScene s;
  s.leave_out_dark_points(device);
  const std::vector<float> g = s.gradient(device);
  for (const size_t k : {2, 13, 30})
    expect_slope_along_the_sphere(s, &LobeScene::lobes, kLobes, k, vector_at(g, kLobes, k), 0.02);
}

TEST(ShadeKernels, AdjointOfAMirrorDirectionEqualsDifferencesAlongTheSphere) {
  const Device device = make_device("cpu/scalar");
  const LobeScene s;
  const std::vector<float> g = s.point_gradient(device);
  for (const size_t i : {0, 5, 40, 63})
    expect_slope_along_the_sphere(s, &LobeScene::mirrors, kPoints, i, vector_at(g, kPoints, i), 0.005);
}

TEST(ShadeKernels, AdjointOfTheDirectionAcrossEqualsDifferences) {
  const Device device = make_device("cpu/scalar");
  const LobeScene s;
  const std::vector<float> g = s.point_gradient(device),
                           across(g.begin() + 3 * kPoints, g.begin() + 6 * kPoints);
  for (const size_t i : {0, 5, 40, 63})
    expect_slope_along_the_sphere(s, &LobeScene::across, kPoints, i, vector_at(across, kPoints, i), 0.005);
}

TEST(ShadeKernels, AdjointOfTheHorizonsNormalEqualsDifferencesAlongTheSphere) {
  LobeScene s;
  std::fill(s.y1.begin(), s.y1.end(), 0.0f);  // without the irradiance, which has an adjoint of its own
  const std::vector<float> g = s.point_gradient(make_device("cpu/scalar")),
                           normal(g.begin() + 8 * kPoints, g.end());
  for (const size_t i : {0, 5, 40, 63})
    expect_slope_along_the_sphere(s, &LobeScene::normals, kPoints, i, vector_at(normal, kPoints, i), 0.005);
}

void expect_slope(std::vector<float> LobeScene::*member, int i, float got) {
  const Device device = make_device("cpu/scalar");
  const auto loss_at = [&](float h) {
    LobeScene moved;
    (moved.*member)[size_t(i)] += h;
    return moved.loss(device);
  };
  const double slope = (loss_at(0.004f) - loss_at(-0.004f)) / 0.008;
  EXPECT_NEAR(got, slope, 0.02 * std::abs(slope) + 0.01) << i;
}

TEST(ShadeKernels, AdjointsOfRoughnessAndStretchEqualDifferences) {
  const std::vector<float> g = LobeScene().point_gradient(make_device("cpu/scalar"));
  for (const int i : {0, 9, 31, 63}) {
    expect_slope(&LobeScene::roughness, i, g[size_t(6 * kPoints + i)]);
    expect_slope(&LobeScene::stretch, i, g[size_t(7 * kPoints + i)]);
  }
}

}  // namespace
}  // namespace cei3d
