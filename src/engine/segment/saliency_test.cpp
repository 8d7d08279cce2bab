// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/saliency.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "core/infer/test_networks.h"

namespace cei3d {
namespace {

const std::filesystem::path kInstalled = source_file("build/sam");  // `./run sam` fills it

constexpr int kWidth = 700, kHeight = 500;
double from_disc(double x, double y) { return std::hypot(x - 450, y - 200); }  // pixels from its center
constexpr double kRadius = 90;

// A red disc on gray.
Image disc() {
  Image out(kWidth, kHeight, 4, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = from_disc(x + 0.5, y + 0.5) < kRadius;
      const float color[3] = {inside ? 0.8f : 0.3f, inside ? 0.05f : 0.3f, inside ? 0.03f : 0.3f};
      std::copy(color, color + 3, out.at(x, y));
    }
  return out;
}

// Means of the map well inside of the disc and well outside.
std::pair<double, double> in_and_out(const Image& map) {
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double d = from_disc((x + 0.5) * kWidth / map.width, (y + 0.5) * kHeight / map.height);
      if (d > 0.9 * kRadius && d < 1.1 * kRadius) continue;
      sum[d > kRadius] += *map.at(x, y), count[d > kRadius] += 1;
    }
  return {sum[0] / count[0], sum[1] / count[1]};
}

class SaliencyTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kInstalled / "libonnxruntime.so.1"))
      GTEST_SKIP() << "no ONNX Runtime here; ./run sam installs it";
    std::filesystem::create_symlink(kInstalled / "libonnxruntime.so.1",
                                    folder_.path() / "libonnxruntime.so.1");
  }
  Saliency with(const std::string& network) {
    write_file_atomic(folder_.path() / "saliency.onnx", network);
    return Saliency::find(folder_.path(), 1).value();
  }
  TempFolder folder_;
};

// A network that returns the mean of the channels: the map is darkest at 0 and brightest at 1, in place.
TEST_F(SaliencyTest, IsTheStretchedOutputOfTheNetwork) {
  using namespace test_networks;
  const auto [inside, outside] =
      in_and_out(with(network(node("ReduceMean", {"x"}, "m", attribute("axes", {1})), {float_tensor("x", 4)},
                              {float_tensor("m", 4)}))
                     .map(disc()));
  EXPECT_LT(std::abs(inside - 0), 1e-5);  // red is darker than this gray: in sRGB .91, .25, .19 and .58
  EXPECT_LT(std::abs(outside - 1), 1e-5);
}

TEST_F(SaliencyTest, OtherNetworksAreRefused) {
  using namespace test_networks;
  EXPECT_THROW(with(network(node("Sub", {"a", "b"}, "c"), {float_tensor("a", 4), float_tensor("b", 4)},
                            {float_tensor("c", 4)})),
               Error);
  EXPECT_THROW(with(channel_means()).map(disc()), Error);
}

TEST(Saliency, IsOptional) {
  const TempFolder folder;
  EXPECT_FALSE(Saliency::find(folder.path()).has_value());
}

TEST(Saliency, FindsADisc) {
  const std::optional<Saliency> saliency = Saliency::find(kInstalled, 1);
  if (!saliency) GTEST_SKIP() << "no network of saliency here; ./run sam installs it";
  const auto [inside, outside] = in_and_out(saliency->map(disc()));
  EXPECT_GT(inside, 0.9);
  EXPECT_LT(outside, 0.1);
}

}  // namespace
}  // namespace cei3d
