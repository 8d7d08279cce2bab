// SPDX-License-Identifier: Apache-2.0
// What `cei3d synth` writes is what the program reads.
#include "engine/synthetic/synthetic_capture.h"

#include <gtest/gtest.h>

#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/normalize.h"
#include "engine/synthetic/views.h"

namespace cei3d {
namespace {

void expect_same(const Camera& got, const Camera& truth) {
  EXPECT_EQ(got.width, truth.width);
  EXPECT_EQ(got.height, truth.height);
  for (const auto& [a, b] :
       {std::pair{got.fx, truth.fx}, {got.fy, truth.fy}, {got.cx, truth.cx}, {got.cy, truth.cy}})
    EXPECT_NEAR(a, b, 1e-9);
  EXPECT_LT(length(got.center - truth.center), 1e-12);
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(length(got.world_from_cam.row[k] - truth.world_from_cam.row[k]), 1e-12);
}

TEST(SyntheticCapture, IsReadBackWithTheSameCameras) {
  const TempFolder temp;
  SynthRequest r;
  r.out = temp.path() / "teapot";
  r.width = 40, r.height = 30;
  r.views = 12, r.test_views = 3;
  r.samples = 1;
  Progress quiet;
  make_capture(r, quiet);
  const Capture capture = load_capture(r.out);
  EXPECT_EQ(capture.format, "nerf-synthetic");
  EXPECT_TRUE(capture.warnings.empty());
  const std::vector<View> train = views_of(capture, Split::train), test = views_of(capture, Split::test);
  const std::vector<Camera> spread = spread_cameras(12, lens_of_size(40, 30)),
                            spiral = spiral_cameras(3, lens_of_size(40, 30));
  ASSERT_EQ(train.size(), 12u);
  ASSERT_EQ(test.size(), 3u);
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(train[i].name, "train/" + view_stem(i));
    expect_same(train[i].camera, spread[i]);
  }
  for (size_t i = 0; i < 3; ++i) expect_same(test[i].camera, spiral[i]);
  // The object's ball is found where the object is.
  const Normalization n = find_normalization(capture);
  EXPECT_LT(length(n.center), 0.25);
  EXPECT_NEAR(1 / n.scale, 0.95, 0.2);
}

}  // namespace
}  // namespace cei3d
