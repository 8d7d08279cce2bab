// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/render/render.h"
#include "engine/session/test_edits.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

// The left half red, the right half green; 32 x 16.
Image two_colors() {
  Image picture(32, 16, 3, 0.1f);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) picture.at(x, y)[x < 16 ? 0 : 1] = 0.8f;
  return picture;
}

class DecalTest : public EditTest {
 protected:
  PaintCommand decal(const std::string& bytes, Vec2<double> pixel, double width, double turn = 0) {
    PaintStroke s;
    s.view = "train/r_0";
    s.scribble.path = "picture.png";
    s.scribble.bytes = bytes;
    s.decal = DecalPlace{pixel, width, turn};
    return {{s}};
  }
  // Albedo of the painted object at a pixel of the first view.
  Vec3f albedo_at(Vec2<double> pixel) {
    const Scene now = scene("a");
    const Ray rays[] = {three_views().views[0].camera.ray(pixel.x, pixel.y)};
    std::vector<uint32_t> of;
    return appearance_at(session_.device(), now, trace_rays(session_.device(), now, rays, of)).albedo.at(0);
  }
};

TEST_F(DecalTest, ItsCameraLooksAlongTheNormalAndSeesItsWidth) {
  const Camera seen = three_views().views[0].camera;
  for (const double turn : {0.0, 30.0}) {
    const auto over = session_.decal_camera(seen, {{28, 20}, 0.2, turn}, 40, 20);
    ASSERT_TRUE(over);
    const Vec3d point = session_.pick(seen, {28, 20})->position;  // on a ball about the origin
    EXPECT_GT(dot(normalize(point), -to_double(over->forward())), 0.999);
    EXPECT_NEAR(over->project(point).x, 20, 1e-6);
    EXPECT_NEAR(over->project(point).y, 10, 1e-6);
    // A tenth to the right of the picture is its right border, and is to the right in the view.
    const Mat3d axes = transpose(over->world_from_cam);
    EXPECT_NEAR(over->project(point + axes.row[0] * 0.1).x, 40, 1e-6);
    const Vec3d from = seen.project(point), to = seen.project(point + axes.row[0] * 0.1);
    EXPECT_NEAR(std::atan2(to.y - from.y, to.x - from.x) * 180 / kPi, turn, 4);
  }
  EXPECT_FALSE(session_.decal_camera(seen, {{0, 0}, 0.2, 0}, 40, 20));
}

TEST_F(DecalTest, APictureIsOnTheSurface) {
  session_.paint(decal(encode_png(two_colors(), 8), {24, 24}, 0.4), quiet_);
  const Vec3f left = albedo_at({22, 24}), right = albedo_at({26, 24});
  EXPECT_GT(left.x, 2 * left.y);
  EXPECT_GT(right.y, 2 * right.x);
  session_.undo(quiet_);
  session_.paint(decal(encode_jpeg(two_colors(), 95), {24, 24}, 0.4, 180), quiet_);
  const Vec3f turned = albedo_at({22, 24});
  EXPECT_GT(turned.y, 2 * turned.x);
}

TEST_F(DecalTest, ItIsTheStrokeOfItsCamera) {
  Image rgba(32, 16, 4, 1.0f);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) rgba.at(x, y)[c] = two_colors().at(x, y)[c];
  session_.paint(decal(encode_png(two_colors(), 8), {24, 24}, 0.4), quiet_);
  const std::string by_decal = bytes_of(scene("a"));
  session_.undo(quiet_);
  PaintStroke stroke;
  stroke.camera = session_.decal_camera(three_views().views[0].camera, {{24, 24}, 0.4, 0}, 32, 16);
  stroke.scribble.bytes = encode_png(rgba, 8);
  session_.paint({{stroke}}, quiet_);
  EXPECT_EQ(bytes_of(scene("a")), by_decal);
}

TEST_F(DecalTest, WrongDecalsChangeNothing) {
  const std::string before = files_of(folder("a")), png = encode_png(two_colors(), 8);
  const auto message = [&](const PaintCommand& c) {
    try {
      session_.paint(c, quiet_);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(decal(png, {0, 0}, 0.4)), HasSubstr("shows the background"));
  EXPECT_THAT(message(decal(png, {24, 24}, 0)), HasSubstr("a width above 0"));
  EXPECT_THAT(message(decal("nonsense", {24, 24}, 0.4)), HasSubstr("picture.png"));
  EXPECT_EQ(files_of(folder("a")), before);
}

}  // namespace
}  // namespace cei3d
