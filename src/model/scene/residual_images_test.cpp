// SPDX-License-Identifier: Apache-2.0
// Pictures of a plate z = 0 whose color is a known function of the place, and of a smaller plate above it.
#include "model/scene/residual_images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kSize = 60;            // pixels
constexpr float kPixel = 3.0f / 90;  // on the plate

Camera camera_from(Vec3d center) {
  Camera c;
  c.width = c.height = kSize;
  c.fx = c.fy = 90;
  c.cx = c.cy = kSize / 2.0;
  c.center = center;
  c.world_from_cam = upright_rotation(-center, {0, 1, 0});
  return c;
}

// At an angle from the plate's normal, three away.
Vec3d around(float degrees) {
  const double a = degrees * kPi / 180;
  return {3 * std::sin(a), 0, 3 * std::cos(a)};
}

Vec3f at_height(const Ray& r, float z) { return r.origin + r.direction * ((z - r.origin.z) / r.direction.z); }

Hit hit_seen_from(Vec3f position, Vec3d center) {
  return {position, {0, 0, 1}, normalize(to_float(center) - position), 0, 0, 0};
}

using Color = std::function<Vec3f(Vec3f)>;  // of a point of the plate

// cover: half the side of a plate at z = .3 over the middle, which the picture shows black; 0: none.
ResidualImage picture(Vec3d center, const Color& color, float cover = 0) {
  const Camera camera = camera_from(center);
  std::vector<std::array<uint16_t, 2>> pixels;
  std::vector<Vec3f> differences;
  std::vector<float> distances;
  for (uint16_t y = 0; y < kSize; ++y)
    for (uint16_t x = 0; x < kSize; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const Vec3f above = at_height(ray, 0.3f), below = at_height(ray, 0);
      const bool covered = std::abs(above.x) < cover && std::abs(above.y) < cover;
      const Vec3f p = covered ? above : below;
      if (std::abs(p.x) > 0.6f || std::abs(p.y) > 0.6f) continue;
      pixels.push_back({x, y});
      differences.push_back(covered ? Vec3f{0, 0, 0} : color(p));
      distances.push_back(length(p - ray.origin));
    }
  return ResidualImage(camera, pixels, differences, distances);
}

Vec3f ramp(Vec3f p) { return {0.2f * p.x, -0.3f * p.y, 0.1f * (p.x + p.y)}; }
Color constant(float v) {
  return [v](Vec3f) { return Vec3f{v, v, v}; };
}

TEST(ResidualImage, GivesBackWhatItWasMadeFromBetweenPixelsToo) {
  const ResidualImage image = picture(around(20), ramp);
  EXPECT_LT(image.camera().width, kSize);  // the window of the plate alone
  for (const Vec3f p : {Vec3f{0.113f, 0.207f, 0}, Vec3f{-0.37f, 0.05f, 0}, Vec3f{0.31f, -0.44f, 0}}) {
    const std::optional<Vec3f> got = image.at(p, {0, 0, 1});
    ASSERT_TRUE(got);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*got)[c], ramp(p)[c], 3e-3f);
  }
}

TEST(ResidualImage, ShowsNoPointThatItDoesNotSee) {
  const ResidualImage image = picture(around(0), ramp, 0.2f);
  EXPECT_FALSE(image.at({0, 0, 0}, {0, 0, 1}));         // below the smaller plate
  EXPECT_TRUE(image.at({0, 0, 0.3f}, {0, 0, 1}));       // on it
  EXPECT_TRUE(image.at({0.4f, 0, 0}, {0, 0, 1}));       // beside it
  EXPECT_FALSE(image.at({0.4f, 0, 0}, {0, 0, -1}));     // from behind
  EXPECT_FALSE(image.at({0.4f, 0, 0}, {1, 0, 0.05f}));  // grazing
  EXPECT_FALSE(image.at({0.9f, 0, 0}, {0, 0, 1}));      // outside of the window
  EXPECT_FALSE(image.at({0.4f, 0, 10}, {0, 0, 1}));     // behind the camera
}

// Mean over the tent of a pixel that looks straight at the plate, by 16 x 16 points.
float mean_over_pixel(const ResidualImage& image, int x, int y) {
  float sum = 0, total = 0;
  for (int k = 0; k < 256; ++k) {
    const float dx = (float(k % 16) + 0.5f) / 8 - 1, dy = (float(k / 16) + 0.5f) / 8 - 1,
                weight = (1 - std::abs(dx)) * (1 - std::abs(dy));
    const Ray ray = camera_from(around(0)).ray(x + 0.5 + dx, y + 0.5 + dy);
    sum += weight * image.at(at_height(ray, 0), {0, 0, 1})->x;
    total += weight;
  }
  return sum / total;
}

TEST(ResidualImage, IsAsSharpInARenderAsItsPhotograph) {
  const Color stripes = [](Vec3f p) { return Vec3f{0.2f * std::sin(p.x * 2 * kPi / (4 * kPixel)), 0, 0}; };
  const ResidualImage plain = picture(around(0), stripes), sharp = plain.sharpened();
  float error_plain = 0, error_sharp = 0;
  for (int x = 20; x < 40; ++x) {
    const float want = stripes(at_height(camera_from(around(0)).ray(x + 0.5, 30.5), 0)).x;
    error_plain = std::max(error_plain, std::abs(mean_over_pixel(plain, x, 30) - want));
    error_sharp = std::max(error_sharp, std::abs(mean_over_pixel(sharp, x, 30) - want));
  }
  EXPECT_GT(error_plain, 0.04f);  // of an amplitude of .2, a third of which is lost
  EXPECT_LT(error_sharp, 0.01f);
}

// Squares of six pixels: stripes of two are lost, a ramp is not.
TEST(ResidualImage, SmoothedHasNoDetails) {
  const Color striped = [](Vec3f p) {
    const float stripe = std::sin(p.x * 2 * kPi / (2 * kPixel) + 0.5f);
    return ramp(p) + Vec3f{0.1f * stripe, 0.1f * stripe, 0.1f * stripe};
  };
  const ResidualImage smooth = picture(around(0), striped).smoothed(6 * kPixel);
  for (const Vec3f p : {Vec3f{0.113f, 0.207f, 0}, Vec3f{-0.37f, 0.05f, 0}, Vec3f{0.31f, -0.34f, 0}}) {
    const std::optional<Vec3f> got = smooth.at(p, {0, 0, 1});
    ASSERT_TRUE(got);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*got)[c], ramp(p)[c], 0.01f);
  }
  EXPECT_FALSE(smooth.at({0.9f, 0, 0}, {0, 0, 1}));
}

TEST(ResidualImages, PictureOfTheViewItselfCountsAlone) {
  const ResidualImages images({picture(around(0), constant(0.1f)), picture(around(30), constant(0.5f))});
  const auto at = [&](float degrees) { return images.at(hit_seen_from({0.1f, 0, 0}, around(degrees))).x; };
  EXPECT_NEAR(at(0), 0.1f, 0.01f);
  EXPECT_NEAR(at(30), 0.5f, 0.01f);
  EXPECT_GT(at(20), at(10));
  EXPECT_EQ(images.at(hit_seen_from({0.1f, 0, 0}, around(-80))).x, 0);  // no picture from near there
}

// Seven pictures of as many colors, so that on the way some leave the blend and others come in.
TEST(ResidualImages, BlendGoesSteadilyFromPictureToPicture) {
  std::vector<ResidualImage> pictures;
  for (int k = 0; k < 7; ++k)
    pictures.push_back(picture(around(float(12 * k - 36)), constant(k % 2 ? 0.1f * float(k) : 0.05f)));
  const ResidualImages images(std::move(pictures));
  float before = images.at(hit_seen_from({0, 0, 0}, around(-36))).x, largest = 0;
  for (float degrees = -36; degrees <= 36; degrees += 0.1f) {
    const float now = images.at(hit_seen_from({0, 0, 0}, around(degrees))).x;
    largest = std::max(largest, std::abs(now - before));
    before = now;
  }
  EXPECT_LT(largest, 0.05f);  // differences of the pictures: up to .55
}

TEST(ResidualImages, LeavesOutThePictureThatIsNamed) {
  const ResidualImages images({picture(around(0), constant(0.1f)), picture(around(30), constant(0.5f))});
  const auto blend = images.blend(hit_seen_from({0, 0, 0}, around(0)), 0);
  ASSERT_TRUE(blend);
  EXPECT_NEAR(blend->difference.x, 0.5f, 0.01f);
  EXPECT_NEAR(blend->angle, 30 * kPi / 180, 1e-3f);
}

TEST(ResidualImages, StrengthsAreOfTheirAngles) {
  ResidualImages::Strengths s{1, 0.8f, 0.6f, 0.4f, 0.2f, 0.1f, 0};
  ResidualImages images({});
  images.set_strengths(s);
  EXPECT_FLOAT_EQ(images.strength(0), 1);
  EXPECT_FLOAT_EQ(images.strength(20 * kPi / 180), 0.4f);
  EXPECT_FLOAT_EQ(images.strength(15 * kPi / 180), 0.5f);
  EXPECT_FLOAT_EQ(images.strength(3), 0);
}

TEST(ResidualImages, AreStoredAndLoadedAsTheyAre) {
  ResidualImages::Strengths s{1, 0.8f, 0.6f, 0.4f, 0.2f, 0.1f, 0};
  ResidualImages images({picture(around(0), ramp), picture(around(30), ramp)});
  images.set_strengths(s);
  Tensors tensors;
  Json head = Json::object();
  save_residual_images(images, tensors, head);
  const ResidualImages loaded = load_residual_images(tensors, {head.at("residual_images"), "a test"});
  EXPECT_EQ(loaded.strengths(), s);
  for (float x = -0.5f; x < 0.5f; x += 0.07f) {
    const Hit hit = hit_seen_from({x, 0.1f, 0}, around(12));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(loaded.at(hit)[c], images.at(hit)[c]);
  }
  tensors["residual_images/1"].shape = {1, 1, 5};
  EXPECT_THROW(load_residual_images(tensors, {head.at("residual_images"), "a test"}), Error);
}

}  // namespace
}  // namespace cei3d
