// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <gtest/gtest.h>

#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

Image random_picture() {
  Image image(24, 20, 3);
  Rng rng(3, 0, 0);
  for (float& v : image.data) v = srgb_from_linear(0.02f + 0.6f * rng.uniform());
  return image;
}

TEST(Exposure, IsTheFactorOfEachChannel) {
  const Image shown = random_picture();
  const Vec3f truth{1.5f, 0.8f, 0.6f};
  Image photo = exposed(shown, truth);
  Area area(24 * 20, 1);
  for (size_t i = 0; i < 100; ++i) {  // outside of the area anything may stand
    area[i] = 0;
    for (size_t c = 0; c < 3; ++c) photo.data[3 * i + c] = 0.5f;
  }
  const std::optional<Vec3f> found = exposure_between(shown, photo, area);
  ASSERT_TRUE(found);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR((*found)[c], truth[c], 1e-3f);
}

// A photograph that is so bright that a third of it is clipped.
TEST(Exposure, LeavesOutWhatIsClipped) {
  const Image shown = random_picture();
  const std::optional<Vec3f> found =
      exposure_between(shown, exposed(shown, {2.5f, 2.5f, 2.5f}), Area(24 * 20, 1));
  ASSERT_TRUE(found);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR((*found)[c], 2.5f, 1e-2f);
}

TEST(Exposure, OfNextToNothingIsNotKnown) {
  EXPECT_FALSE(exposure_between(random_picture(), random_picture(), Area(24 * 20, 0)));
}

}  // namespace
}  // namespace cei3d
