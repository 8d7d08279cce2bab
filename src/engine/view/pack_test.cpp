// SPDX-License-Identifier: Apache-2.0
#include "engine/view/pack.h"

#include <gtest/gtest.h>

#include "core/base/json.h"
#include "core/math/rng.h"
#include "engine/view/quantize.h"
#include "engine/view/test_pack.h"

namespace cei3d {
namespace {

TEST(Pack, HoldsArraysAtMultiplesOfFour) {
  Pack pack("thing");
  pack["name"] = "a\"b";
  pack.add("bytes", std::vector<uint8_t>{1, 2, 3}, 3);
  pack.add("numbers", std::vector<float>{0.5f, -2, 3, 4}, 2);
  const std::string bytes = pack.bytes();
  const ReadPack read(bytes);
  EXPECT_EQ(read.head.at("kind"), "thing");
  EXPECT_EQ(read.head.at("name"), "a\"b");
  EXPECT_EQ(read.array<uint8_t>("bytes"), (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ(read.array<float>("numbers"), (std::vector<float>{0.5f, -2, 3, 4}));
  EXPECT_EQ(read.head.at("arrays").at("numbers").at("shape"), (Json{2, 2}));
  EXPECT_EQ((bytes.size() - read.data.size()) % 4, 0u);
  EXPECT_EQ(read.head.at("arrays").at("numbers").at("at").get<size_t>() % 4, 0u);
}

TEST(Quantize, SharedExponentsAreWithinHalfAStepOfTheLargest) {
  for (uint64_t i = 0; i < 2000; ++i) {
    Rng rng(3, 0, i);
    const float size = std::exp(12 * rng.uniform() - 6);
    const Vec3f color{size * rng.uniform(), size * rng.uniform(), size};
    const Vec3f back = from_shared_exponent(shared_exponent(color));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], color[c], size / 511) << i;
  }
  EXPECT_EQ(shared_exponent({0, 0, 0}), 0u);
  EXPECT_EQ(from_shared_exponent(shared_exponent({1, 0.5f, 0})).x, 1);
  EXPECT_EQ(from_shared_exponent(shared_exponent({0.99999f, 0, 0})).x,
            1);  // rounds up to the next power of two
  EXPECT_EQ(from_shared_exponent(shared_exponent({1e9f, 0, 0})).x, 65408);
  EXPECT_EQ(from_shared_exponent(shared_exponent({-1, 0, 0})).x, 0);
}

}  // namespace
}  // namespace cei3d
