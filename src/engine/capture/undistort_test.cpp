// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/undistort.h"

#include <gmock/gmock.h>

#include "core/base/error_of.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {
using testing::HasSubstr;

View photographed() {
  View view;
  view.name = "images/a";
  const TestView v = test_views(TestBall(), 1, 200, 150)[0];
  view.photo = PhotoCamera(v.camera, {LensKind::perspective, {-0.22, 0.07, 0, 0}, {}, 0.003, -0.002});
  view.camera = pinhole_around(*view.photo, {40, 30, 170, 120}, view.name);
  return view;
}

// What is drawn on the photograph where it shows a point of the object lies where the view shows it.
TEST(Undistort, DrawingsAndClicksOnThePhotographFollowTheLens) {
  const View view = photographed();
  const TestBall ball;
  for (const Vec3d d : {Vec3d{0.3, 0.2, 0.5}, Vec3d{-0.4, 0.1, 0.2}, Vec3d{0.1, -0.5, -0.3}}) {
    const Vec3d point = ball.center + d, seen = view.camera.project(point);
    const Vec2d photo = *project(*view.photo, point);
    const Vec2d click = position_on_view(view, photo);
    EXPECT_NEAR(click.x, seen.x, 1e-6);
    EXPECT_NEAR(click.y, seen.y, 1e-6);
    Image drawing(200, 150, 4);
    for (int y = -3; y <= 3; ++y)
      for (int x = -3; x <= 3; ++x) drawing.at(int(photo.x) + x, int(photo.y) + y)[3] = 1;
    const Image on_view = drawn_on_view(view, drawing);
    ASSERT_EQ(on_view.width, view.camera.width);
    double x = 0, y = 0, n = 0;
    for (int r = 0; r < on_view.height; ++r)
      for (int c = 0; c < on_view.width; ++c) {
        const double a = on_view.at(c, r)[3];
        x += a * (c + 0.5), y += a * (r + 0.5), n += a;
      }
    EXPECT_NEAR(x / n, seen.x, 0.8);  // the square is centered on a pixel
    EXPECT_NEAR(y / n, seen.y, 0.8);
  }
}

TEST(Undistort, ImagesOfTheViewsOwnSizeAreTakenAsTheyAre) {
  const View view = photographed();
  const Image own(view.camera.width, view.camera.height, 4, 0.3f);
  EXPECT_EQ(drawn_on_view(view, own).data, own.data);
  EXPECT_FALSE(view.camera.width == 200 && view.camera.height == 150);
  View plain = view;
  plain.photo.reset();
  EXPECT_EQ(position_on_view(plain, {3, 4}).x, 3);
}

TEST(Undistort, TheViewHoldsTheBox) {
  const View view = photographed();
  for (const Vec2d corner :
       {Vec2d{40, 30}, Vec2d{170, 30}, Vec2d{40, 120}, Vec2d{170, 120}, Vec2d{100, 30}}) {
    const Vec2d p = *pinhole_from_photo(*view.photo, view.camera, corner);
    EXPECT_GT(p.x, 7);
    EXPECT_GT(p.y, 7);
    EXPECT_LT(p.x, view.camera.width - 7);
    EXPECT_LT(p.y, view.camera.height - 7);
  }
  EXPECT_LT(view.camera.width, 165);
}

// A constant stays constant, a ramp a ramp: samples are weighted to one.
TEST(Undistort, ConstantsStay) {
  const View view = photographed();
  const Image out = undistorted(Image(200, 150, 4, 0.5f), *view.photo, view.camera);
  for (int y = 10; y < out.height - 10; ++y)
    for (int x = 10; x < out.width - 10; ++x)
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(out.at(x, y)[c], 0.5f, 1e-5f);
}

TEST(Undistort, ImpossibleLensesAreErrors) {
  const Camera c = test_views(TestBall(), 1, 200, 150)[0].camera;
  const PhotoBox whole{0, 0, 200, 150};
  EXPECT_THAT(message([&] {
                pinhole_around({c, {LensKind::perspective, {-9, 0, 0, 0}, {}, 0, 0}}, whole, "images/a");
              }),
              HasSubstr("images/a"));
  Camera wide = c;
  wide.fx = wide.fy = 60;
  EXPECT_THAT(message([&] {
                pinhole_around({wide, {LensKind::fisheye, {}, {}, 0, 0}}, whole, "images/a");
              }),
              HasSubstr("60 degrees"));
}

}  // namespace
}  // namespace cei3d
