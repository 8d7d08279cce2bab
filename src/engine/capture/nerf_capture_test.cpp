// SPDX-License-Identifier: Apache-2.0
// Keys of nerfstudio's transforms.json that say where its frame comes from.
#include <gtest/gtest.h>

#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {

class NerfFrame : public testing::Test {
 protected:
  // Cameras on one side, on their side: their own up axes lie along x, the object stands along z.
  Json file_of_cameras() const {
    Json j{{"w", 64}, {"h", 48}, {"fl_x", 90.0}, {"frames", Json::array()}};
    for (int i = 0; i < 8; ++i) {
      const Vec3d eye{0.3 - 0.1 * i, -4, 0.2 * i};
      j["frames"].push_back(
          nerf_frame(fmt::format("r_{}", i), look_at(eye, {0, 0, 0}, {64, 48, 90}, {1, 0, 0})));
    }
    return j;
  }
  Capture load(const Json& file) const {
    write_file_atomic(temp_.path() / "transforms.json", file.dump());
    return load_capture(temp_.path());
  }
  const TempFolder temp_;
};

// Results are in the frame of the file, however it was made from that of COLMAP.
TEST_F(NerfFrame, IsThatOfTheFile) {
  Json file = file_of_cameras();
  const Capture plain = load(file);
  file["applied_transform"] = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 2}};
  file["applied_scale"] = 0.5;
  const Capture applied = load(file);
  ASSERT_EQ(applied.views.size(), 8u);
  for (size_t i = 0; i < 8; ++i) {
    const Camera &a = plain.views[i].camera, &b = applied.views[i].camera;
    EXPECT_EQ(length(a.center - b.center), 0);
    for (int r = 0; r < 3; ++r) EXPECT_EQ(length(a.world_from_cam.row[r] - b.world_from_cam.row[r]), 0);
  }
}

TEST_F(NerfFrame, IsUprightWhereTheFileSaysSo) {
  Json file = file_of_cameras();
  EXPECT_EQ(load(file).up.x, 1);  // by the cameras
  for (const Json& other : {Json("up"), Json("vertical"), Json("pca"), Json(3), Json()}) {
    file["orientation_override"] = other;
    EXPECT_EQ(load(file).up.x, 1) << other;
  }
  file["orientation_override"] = "none";
  EXPECT_EQ(load(file).up.z, 1);
}

}  // namespace
}  // namespace cei3d
