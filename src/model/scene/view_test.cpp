// SPDX-License-Identifier: Apache-2.0
#include "model/scene/view.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

Camera small_camera(double focal) {
  Camera c;
  c.width = 200;
  c.height = 150;
  c.fx = c.fy = focal;
  c.cx = 104;
  c.cy = 71;
  c.center = {0.5, 0, -3};
  return c;
}

Capture two_views() {
  Capture capture;
  for (const Split split : {Split::train, Split::test}) {
    View v;
    v.name = split == Split::train ? "train/a" : "test/b";
    v.split = split;
    v.camera = small_camera(190);
    v.photo = PhotoCamera(small_camera(180), {LensKind::perspective, {-0.22, 0.07, 0, 0}, {}, 0.003, -0.002});
    capture.views.push_back(v);
  }
  return capture;
}

// Pixels of a photograph lie in the same pixels of the pinhole camera, in which the object was reconstructed.
TEST(WithCameras, AFocalLengthIsThatOfAllViewsAndLeavesTheirPixels) {
  const Capture given = two_views();
  RefinedCameras refined{{{"train/a", Mat3d::identity(), {1, 2, -4}}}, 1.03};
  const Capture found = with_cameras(given, refined);
  EXPECT_EQ(found.views[0].camera.center.y, 2);
  EXPECT_EQ(found.views[1].camera.center.y, 0);  // of the held-out view
  for (size_t i = 0; i < 2; ++i) {
    const View &before = given.views[i], &after = found.views[i];
    EXPECT_EQ(after.camera.fx, 1.03 * 190);
    EXPECT_EQ(after.file_camera().fy, 1.03 * 180);
    EXPECT_EQ(after.camera.cx, 104);
    for (const Vec2d p : {Vec2d{104, 71}, Vec2d{3, 140}, Vec2d{190, 20}}) {
      const auto a = photo_from_pinhole(*before.photo, before.camera, p),
                 b = photo_from_pinhole(*after.photo, after.camera, p);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->x, b->x, 1e-9);
      EXPECT_NEAR(a->y, b->y, 1e-9);
    }
  }
}

}  // namespace
}  // namespace cei3d
