// SPDX-License-Identifier: Apache-2.0
// LPIPS and FID: on small networks whose values are known, and on sets whose Gaussians are known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "core/infer/test_networks.h"
#include "engine/metrics/fid.h"
#include "engine/metrics/lpips.h"

namespace cei3d {
namespace {

FeatureSet set_of(const std::vector<std::vector<float>>& rows) {
  FeatureSet s;
  for (const auto& row : rows) s.add(row);
  return s;
}

FeatureSet random_set(int n, int dimensions, unsigned seed, float spread = 1, float shift = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  FeatureSet s;
  for (int i = 0; i < n; ++i) {
    std::vector<float> row;
    for (int d = 0; d < dimensions; ++d) row.push_back(normal(random) * spread + shift);
    s.add(row);
  }
  return s;
}

// Four points whose mean is m and whose covariance is A A^T: m + A (+-s, 0), m + A (0, +-s), s^2 = 3 / 2.
struct Gaussian2 {
  double m[2], a[2][2];
  FeatureSet set() const {
    const double s = std::sqrt(1.5);
    FeatureSet out;
    for (const auto& [x, y] : {std::pair{s, 0.0}, {-s, 0.0}, {0.0, s}, {0.0, -s}})
      out.add({float(m[0] + a[0][0] * x + a[0][1] * y), float(m[1] + a[1][0] * x + a[1][1] * y)});
    return out;
  }
  double cov(int i, int j) const { return a[i][0] * a[j][0] + a[i][1] * a[j][1]; }
  double det() const { return cov(0, 0) * cov(1, 1) - cov(0, 1) * cov(1, 0); }
};

TEST(Frechet, TwoGaussiansInThePlaneInClosedForm) {
  const Gaussian2 p{{1, 2}, {{2, 0.5}, {-0.3, 1}}}, q{{-1, 0.5}, {{0.7, 0}, {1.5, 3}}};
  // The trace of the root of a 2x2 matrix M with positive eigenvalues: sqrt(tr M + 2 sqrt(det M)).
  double product = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) product += p.cov(i, j) * q.cov(j, i);
  const double root = std::sqrt(product + 2 * std::sqrt(p.det() * q.det()));
  const double traces = p.cov(0, 0) + p.cov(1, 1) + q.cov(0, 0) + q.cov(1, 1);
  EXPECT_NEAR(frechet_distance(p.set(), q.set()), 4 + 2.25 + traces - 2 * root, 1e-5);
}

TEST(Frechet, NothingBetweenASetAndItselfInAnyOrder) {
  const FeatureSet s = random_set(7, 20, 1);
  EXPECT_NEAR(frechet_distance(s, s), 0, 1e-9);
  FeatureSet reversed;
  for (size_t i = s.size(); i-- > 0;)
    reversed.add({s.rows.begin() + std::ptrdiff_t(20 * i), s.rows.begin() + std::ptrdiff_t(20 * (i + 1))});
  EXPECT_NEAR(frechet_distance(s, reversed), 0, 1e-9);
}

// A shift costs its squared length; a set k times as wide costs (k - 1)^2 times the trace.
TEST(Frechet, ShiftsAndScales) {
  const FeatureSet s = random_set(30, 5, 2), shifted = random_set(30, 5, 2, 1, 3);
  EXPECT_NEAR(frechet_distance(s, shifted), 5 * 9, 1e-3);
  const FeatureSet pair = set_of({{-1, 0}, {1, 0}}), wide = set_of({{-3, 0}, {3, 0}});
  EXPECT_NEAR(frechet_distance(pair, wide), 4 * 2, 1e-9);  // variance 2
  const FeatureSet other = random_set(12, 5, 3);
  EXPECT_NEAR(frechet_distance(s, other), frechet_distance(other, s), 1e-9);
}

TEST(Frechet, RefusesWhatHasNoCovariance) {
  EXPECT_THROW(frechet_distance(set_of({{1, 2}}), random_set(4, 2, 1)), Error);
  EXPECT_THROW(frechet_distance(random_set(4, 3, 1), random_set(4, 2, 1)), Error);
  FeatureSet s = set_of({{1, 2}});
  EXPECT_THROW(s.add({1, 2, 3}), Error);
}

// A ramp stays the same ramp, in whatever resolution.
TEST(Features, ResizingKeepsALinearRamp) {
  Image ramp(20, 10, 3);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x)
      ramp.at(x, y)[0] = (float(x) + 0.5f) / 20, ramp.at(x, y)[1] = (float(y) + 0.5f) / 10;
  const Image big = resized_for_features(ramp, 60, 60);
  for (int y = 6; y < 54; ++y)
    for (int x = 3; x < 57; ++x) {
      EXPECT_NEAR(big.at(x, y)[0], (float(x) + 0.5f) / 60, 1e-5);
      EXPECT_NEAR(big.at(x, y)[1], (float(y) + 0.5f) / 60, 1e-5);
    }
  EXPECT_EQ(resized_for_features(ramp, 20, 10).data, ramp.data);
}

const std::filesystem::path kFolder = source_file("build/sam");

class Networks : public testing::Test {
 protected:
  void SetUp() override {
    if (!OnnxRuntime::available(kFolder)) GTEST_SKIP() << "no ONNX Runtime here; ./run sam installs it";
    runtime_ = std::make_shared<OnnxRuntime>(kFolder);
  }
  std::filesystem::path file(const std::string& content) {
    const auto path = folder_.path() / "network.onnx";
    write_file_atomic(path, content);
    return path;
  }
  std::shared_ptr<const OnnxRuntime> runtime_;
  TempFolder folder_;
};

// The small network is the mean squared difference, of values in [-1, 1]: four times that in [0, 1].
TEST_F(Networks, LpipsGivesBothPicturesToTheNetwork) {
  const Lpips lpips(runtime_, file(test_networks::squared_distance()), 1);
  Image a(4, 3, 3, 0.25f), b(4, 3, 3, 0.75f);
  EXPECT_NEAR(lpips.distance(a, b), 4 * 0.25, 1e-6);
  EXPECT_EQ(lpips.distance(a, a), 0);
  b = a;
  b.at(2, 1)[1] = 1.25f;
  EXPECT_NEAR(lpips.distance(a, b), 4.0 / 36, 1e-6);
  EXPECT_THROW(lpips.distance(a, Image(3, 3, 3)), Error);
}

TEST_F(Networks, FeaturesAreThoseOfTheResizedPicture) {
  const FeatureNetwork network(runtime_, file(test_networks::channel_means()), 1);
  Image a(10, 4, 3);
  for (size_t i = 0; i < 40; ++i) a.data[3 * i] = 0.5f, a.data[3 * i + 2] = 0.125f;
  const std::vector<float> f = network.features(a);
  ASSERT_EQ(f.size(), 3u);
  EXPECT_NEAR(f[0], 0.5f, 1e-5);
  EXPECT_NEAR(f[1], 0, 1e-6);
  EXPECT_NEAR(f[2], 0.125f, 1e-5);
}

TEST_F(Networks, OthersAreRefused) {
  EXPECT_THROW(Lpips(runtime_, file(test_networks::channel_means()), 1), Error);
  EXPECT_THROW(FeatureNetwork(runtime_, file(test_networks::squared_distance()), 1), Error);
  using namespace test_networks;
  const Lpips map(runtime_,
                  file(network(node("Sub", {"a", "b"}, "c"), {float_tensor("a", 4), float_tensor("b", 4)},
                               {float_tensor("c", 4)})),
                  1);
  EXPECT_THROW(map.distance(Image(4, 3, 3), Image(4, 3, 3)), Error);  // a map, not one number
}

}  // namespace
}  // namespace cei3d
