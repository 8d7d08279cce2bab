// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/loose_border.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/capture/doctor.h"
#include "engine/capture/test_balls.h"

namespace cei3d {
namespace {

constexpr int kSize = 200;
constexpr double kRadius = 70;  // of the disc that was photographed, pixels

double distance_from_center(int x, int y) { return std::hypot(x + 0.5 - kSize / 2.0, y + 0.5 - kSize / 2.0); }

// A grained disc, sRGB `object`, on a background with a soft shadow; the outline is a pixel wide.
Image photograph_of_disc(Vec3f object) {
  Image out(kSize, kSize, 4, 1);
  Rng rng(3, 0, 0);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const auto covered = float(std::clamp(kRadius + 0.5 - distance_from_center(x, y), 0.0, 1.0));
      const float grain = 0.1f * (rng.uniform() - 0.5f), noise = 0.01f * (rng.uniform() - 0.5f);
      const float shadow = 0.9f - 0.3f * float(x) / kSize;
      const Vec3f color = (object + Vec3f{grain, grain, grain}) * covered +
                          Vec3f{shadow + noise, shadow + noise, shadow + noise} * (1 - covered);
      for (int k = 0; k < 3; ++k) out.at(x, y)[k] = linear_from_srgb(color[k]);
    }
  return out;
}
constexpr Vec3f kWood{0.5f, 0.35f, 0.2f};

// A disc whose right half has a larger radius.
std::vector<uint8_t> mask_of_disc(double radius, double right_radius) {
  std::vector<uint8_t> out;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      out.push_back(distance_from_center(x, y) < (x < kSize / 2 ? radius : right_radius) ? kObject
                                                                                         : kBackground);
  return out;
}

Camera camera_of_photograph() {
  Camera c;
  c.width = c.height = kSize;
  return c;
}

// At 200 pixels the band is three wide.
TEST(LooseBorder, IsTheBackgroundWithinTheMask) {
  const double wide = kRadius + 3;
  const std::vector<uint8_t> mask = mask_of_disc(kRadius, wide);
  const Area loose = loose_border(photograph_of_disc(kWood), {camera_of_photograph(), mask});
  Area extra(mask.size()), object(mask.size());
  for (size_t i = 0; i < mask.size(); ++i) {
    const double d = distance_from_center(int(i) % kSize, int(i) / kSize);
    extra[i] = mask[i] == kObject && d > kRadius + 1;
    object[i] = d < kRadius - 1;
  }
  EXPECT_GT(share_of(loose, extra), 0.9);
  EXPECT_EQ(share_of(loose, object), 0);
}

TEST(LooseBorder, GoodMasksHaveNone) {
  const Image photograph = photograph_of_disc(kWood);
  for (const double inset : {0.0, 1.0, 4.0}) {
    const std::vector<uint8_t> mask = mask_of_disc(kRadius - inset, kRadius - inset);
    EXPECT_EQ(pixels_in(loose_border(photograph, {camera_of_photograph(), mask})), 0u) << inset;
  }
}

// Where the photograph has no outline the mask is believed.
TEST(LooseBorder, NothingIsFoundWhereObjectAndBackgroundAreAlike) {
  const Image gray(kSize, kSize, 4, 0.5f);
  const std::vector<uint8_t> mask = mask_of_disc(kRadius, kRadius + 3);
  EXPECT_EQ(pixels_in(loose_border(gray, {camera_of_photograph(), mask})), 0u);
}

TEST(LooseBorder, MasksThatStandOutAreNamed) {
  const Image photograph = photograph_of_disc(kWood);
  const std::vector<uint8_t> good = mask_of_disc(kRadius, kRadius), wide = mask_of_disc(kRadius, kRadius + 3);
  std::vector<View> views(8);
  std::vector<MaskBorder> borders(8);
  std::vector<JudgedMask> judged;
  for (size_t i = 0; i < views.size(); ++i) {
    views[i].name = fmt::format("img_{}", i);
    views[i].mask_path = "mask.png";
    views[i].camera = camera_of_photograph();
    const std::vector<uint8_t>& mask = i == 5 ? wide : good;
    borders[i] = look_at_border(views[i], photograph, mask);
    judged.push_back({&views[i], mask, nullptr, &borders[i]});
  }
  std::vector<Finding> findings;
  const std::vector<Area> areas = check_borders(judged, findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].what, testing::HasSubstr("1 of 8 masks seem to be drawn wider"));
  EXPECT_THAT(findings[0].what, testing::HasSubstr("img_5"));
  for (size_t i = 0; i < areas.size(); ++i) EXPECT_EQ(areas[i].empty(), i != 5) << i;
  EXPECT_EQ(areas[5].size(), size_t(kSize) * kSize);
}

// A mask that is the image's transparency has no background beside it.
TEST(LooseBorder, IsNotLookedForInTransparentImages) {
  View view;
  view.camera = camera_of_photograph();
  const std::vector<uint8_t> wide = mask_of_disc(kRadius, kRadius + 3);
  EXPECT_TRUE(look_at_border(view, photograph_of_disc(kWood), wide).loose.empty());
}

}  // namespace
}  // namespace cei3d
