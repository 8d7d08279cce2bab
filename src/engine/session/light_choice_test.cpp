// SPDX-License-Identifier: Apache-2.0
#include "engine/session/light_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "engine/io/image_file.h"
#include "engine/io/npy.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

// A gray sky with one bright patch about the pixel position (u, v).
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

TEST_F(LightChoiceTest, CenterAndQuarterOfEachConvention) {
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

// A map whose pixels are colored by the axis that they look along most: written from the definition of the
// layout, pixel by pixel, not by the code under test.
const Vec3f kAxes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const Vec3f kLabels[6] = {{9, 1, 1}, {1, 9, 1}, {1, 1, 9}, {9, 9, 1}, {1, 9, 9}, {9, 1, 9}};
Image labeled_sky(bool y_up) {
  Image map(128, 64, 3);
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 128; ++i) {
      const double theta = M_PI * (j + 0.5) / 64, phi = 2 * M_PI * (0.5 - (i + 0.5) / 128);
      Vec3d d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      if (y_up) d = {d.y, d.z, d.x};  // row 0 is +Y, the center +Z, column W/4 +X
      int best = 0;
      for (int a = 1; a < 6; ++a)
        if (dot(d, to_double(kAxes[a])) > dot(d, to_double(kAxes[best]))) best = a;
      for (int c = 0; c < 3; ++c) map.at(i, j)[c] = kLabels[best][c];
    }
  return map;
}

TEST_F(LightChoiceTest, EveryAxisOfALabeledMapHasItsColor) {
  const Device device = make_device();
  for (const bool y_up : {false, true}) {
    const auto file = temp_.path() / "labeled.hdr";
    write_hdr(file, labeled_sky(y_up));
    const Vec3d up = y_up ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    const SgMixture light = chosen_light(device, {file, 0, EnvConvention::by_up_axis}, {}, up);
    for (int a = 0; a < 6; ++a) {
      const Vec3f got = radiance(light, kAxes[a]);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(got[c] > 5, kLabels[a][c] > 5) << a << ' ' << c << ' ' << got[c];
    }
  }
}

TEST_F(LightChoiceTest, AFitIsCachedByContentAndComesBackInTheSameBits) {
  const Device device = make_device();
  const auto file = temp_.path() / "sky.hdr";
  write_hdr(file, sky_with_sun(64, 32));
  const LightChoice choice{file, 0, EnvConvention::zup};
  const LightCache cache{temp_.path() / "cache", true};
  const auto first = to_array(environment_light(device, choice, {0, 0, 1}, cache));
  ASSERT_EQ(std::distance(std::filesystem::directory_iterator(cache.folder), {}), 1);
  const auto entry = std::filesystem::directory_iterator(cache.folder)->path();
  EXPECT_EQ(to_array(environment_light(device, choice, {0, 0, 1}, cache)), first);
  write_hdr(file, sky_with_sun(32, 32));  // another picture of the same name
  EXPECT_NE(to_array(environment_light(device, choice, {0, 0, 1}, cache)), first);
  write_hdr(file, sky_with_sun(64, 32));
  write_file_atomic(entry, "not lobes");
  EXPECT_EQ(to_array(environment_light(device, choice, {0, 0, 1}, cache)), first);
}

TEST_F(LightChoiceTest, LobesComeAsTheyWereExported) {
  const Device device = make_device();
  const SgMixture own{{{{0, 0.6f, 0.8f}, 5, {1, 2, 3}}, {{1, 0, 0}, 50, {0.5f, 0, 0}}}};
  const auto file = temp_.path() / "light.npy";
  write_npy(file, to_array(own), 2, 7);
  const SgMixture back = chosen_light(device, {file, 0, EnvConvention::by_up_axis, 2}, {}, {0, 1, 0});
  ASSERT_EQ(back.lobes.size(), 2u);
  EXPECT_NEAR(back.lobes[0].axis.y, 0.6f, 1e-6f);
  EXPECT_EQ(back.lobes[0].mu.z, 6);
  write_npy(file, to_array(own), 7, 2);
  EXPECT_THROW(chosen_light(device, {file, 0, EnvConvention::zup}, {}, {0, 0, 1}), Error);
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
  for (const double scale : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(chosen_light(device, {"", 0, EnvConvention::zup, scale}, {}, {0, 0, 1}), Error);
  EXPECT_THROW(chosen_light(device, {"", NAN, EnvConvention::zup, 1}, {}, {0, 0, 1}), Error);
  EXPECT_THROW(light_of(Image(64, 32, 3, 0)), Error);
  EXPECT_THROW(chosen_light(device, {temp_.path() / "none.hdr", 0, EnvConvention::zup}, {}, {0, 0, 1}),
               Error);
}

}  // namespace
}  // namespace cei3d
