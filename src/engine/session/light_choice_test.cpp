// SPDX-License-Identifier: Apache-2.0
#include "engine/session/light_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/temp_folder.h"
#include "engine/io/image_file.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

// A grey sky with one bright patch about the pixel position (u, v).
Image sky_with_sun(float u, float v) {
  Image map(128, 64, 3, 0.1f);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x)
      if (std::hypot(x + 0.5f - u, y + 0.5f - v) < 5)
        for (int c = 0; c < 3; ++c) map.at(x, y)[c] = 20;
  return map;
}

// Where the light is brightest.
Vec3f brightest(const SgMixture& light) {
  Vec3f best{0, 0, 1};
  for (const SgLobe& l : light.lobes)
    if (radiance(light, l.axis).x > radiance(light, best).x) best = l.axis;
  return best;
}

class LightChoiceTest : public ::testing::Test {
 protected:
  Vec3f sun(float u, float v, EnvConvention convention, Vec3d up, double degrees = 0) {
    const auto file = temp_.path() / "sky.hdr";
    write_hdr(file, sky_with_sun(u, v));
    const Device device = make_device();
    return brightest(chosen_light(device, {file, degrees, convention}, {}, up));
  }
  // Within 17 degrees: lobes are coarse, mistaken axes are 90 degrees off.
  static void expect_near(Vec3f a, Vec3f b) {
    EXPECT_GT(dot(a, b), std::cos(0.3f)) << a.x << " " << a.y << " " << a.z;
  }
  TempFolder temp_;
};

TEST_F(LightChoiceTest, CentreAndQuarterOfEachConvention) {
  const Vec3d z{0, 0, 1}, y{0, 1, 0};
  expect_near(sun(64, 32, EnvConvention::by_up_axis, z), {1, 0, 0});
  expect_near(sun(32, 32, EnvConvention::by_up_axis, z), {0, 1, 0});
  expect_near(sun(64, 32, EnvConvention::zup, y), {1, 0, 0});
  expect_near(sun(32, 32, EnvConvention::blender, y), {0, 1, 0});
  expect_near(sun(64, 32, EnvConvention::by_up_axis, y), {0, 0, 1});
  expect_near(sun(32, 32, EnvConvention::mitsuba, z), {1, 0, 0});
  expect_near(sun(32, 32, EnvConvention::yup, z), {1, 0, 0});
}

TEST_F(LightChoiceTest, TheTopOfThePictureIsUpWhateverTheAxis) {
  for (const Vec3d up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}, Vec3d{1, 0, 0}, Vec3d{0, -1, 0}})
    expect_near(sun(64, 2, EnvConvention::by_up_axis, up), to_float(up));
}

TEST_F(LightChoiceTest, TurnsCounterClockwiseSeenFromAbove) {
  expect_near(sun(64, 32, EnvConvention::by_up_axis, {0, 0, 1}, 90), {0, 1, 0});
  expect_near(sun(64, 32, EnvConvention::by_up_axis, {0, 1, 0}, 90), {1, 0, 0});  // z to x about y
}

TEST_F(LightChoiceTest, TheOwnLightTurnsToo) {
  const SgMixture own{{{{1, 0, 0}, 5, {1, 1, 1}}}};
  const Device device = make_device();
  const SgMixture same = chosen_light(device, {}, own, {0, 0, 1});
  EXPECT_EQ(same.lobes[0].axis.x, 1);
  expect_near(chosen_light(device, {"", 180, EnvConvention::by_up_axis}, own, {0, 0, 1}).lobes[0].axis,
              {-1, 0, 0});
}

TEST_F(LightChoiceTest, RefusesWhatIsNoEnvironment) {
  const Device device = make_device();
  const auto light_of = [&](const Image& map) {
    const auto file = temp_.path() / "x.hdr";
    write_hdr(file, map);
    chosen_light(device, {file, 0, EnvConvention::zup}, {}, {0, 0, 1});
  };
  EXPECT_THROW(light_of(Image(64, 64, 3, 1)), Error);
  EXPECT_THROW(light_of(Image(64, 32, 3, 0)), Error);
  EXPECT_THROW(chosen_light(device, {temp_.path() / "none.hdr", 0, EnvConvention::zup}, {}, {0, 0, 1}),
               Error);
}

}  // namespace
}  // namespace cei3d
