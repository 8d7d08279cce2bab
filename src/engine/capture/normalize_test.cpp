// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/normalize.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/base/error_of.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {
using testing::HasSubstr;

struct MaskSet {
  std::vector<std::vector<uint8_t>> pixels;
  std::vector<HullMask> views;
};

MaskSet ball_masks(const TestBall& ball, const std::vector<TestView>& views) {
  MaskSet set;
  for (const TestView& v : views) {
    const Image image = ball_image(ball, v.camera);
    auto& m = set.pixels.emplace_back(size_t(image.width) * image.height);
    for (size_t i = 0; i < m.size(); ++i) m[i] = image.data[4 * i + 3] > 0.5f;
  }
  for (size_t i = 0; i < views.size(); ++i) set.views.push_back({views[i].camera, set.pixels[i]});
  return set;
}

void expect_ball(const Normalization& n, const TestBall& ball) {
  EXPECT_NEAR(length(n.center - ball.center) / ball.radius, 0, 0.05);
  EXPECT_NEAR(n.scale * ball.radius, 0.9, 0.06);
  EXPECT_LT(n.scale * ball.radius, 0.91);
}

TEST(Normalize, FindsABallAtAnyPlaceAndScale) {
  for (const TestBall ball : {TestBall{}, TestBall{{1000, 2000, -50}, 300}, TestBall{{0, 0, 0}, 0.001}})
    expect_ball(normalization_from_masks(ball_masks(ball, test_views(ball, 20, 120, 90)).views), ball);
}

TEST(Normalize, IsInvertible) {
  const Normalization n{{1, 2, 3}, 0.25};
  EXPECT_NEAR(length(n.capture_from_unit(n.unit_from_capture(Vec3d{4, 5, 6})) - Vec3d{4, 5, 6}), 0, 1e-12);
}

TEST(Normalize, ViewsThatCutTheObjectAreNoEvidenceAgainstIt) {
  const TestBall ball;
  auto views = test_views(ball, 40, 120, 90);
  for (size_t i = 0; i < views.size(); i += 4)
    views[i].camera.fx = views[i].camera.fy = 420;  // the ball fills the frame
  expect_ball(normalization_from_masks(ball_masks(ball, views).views), ball);
}

TEST(Normalize, AStatedRegionHoldsWhatThePicturesCut) {
  const TestBall ball;
  auto views = test_views(ball, 40, 120, 90);
  for (auto& v : views) v.camera.fx = v.camera.fy = 420;  // the ball fills every frame
  const MaskSet set = ball_masks(ball, views);
  const Normalization alone = normalization_from_masks(set.views);
  EXPECT_LT(alone.scale * ball.radius, 0.8);
  std::vector<std::string> warnings;
  expect_ball(normalization_from_masks(set.views, &warnings, ObjectBall{ball.center, ball.radius}), ball);
  EXPECT_TRUE(warnings.empty());
  const ObjectBall elsewhere{ball.center + Vec3d{50, 0, 0} * ball.radius, ball.radius};
  const Normalization got = normalization_from_masks(set.views, &warnings, elsewhere);
  EXPECT_EQ(got.scale, alone.scale);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST(Normalize, OneWrongMaskInTwentyIsOutvotedAndSaid) {
  const TestBall ball;
  MaskSet set = ball_masks(ball, test_views(ball, 40, 120, 90));
  // Half of the object is missing.
  std::fill(set.pixels[7].begin() + 45 * 120, set.pixels[7].end(), uint8_t(0));
  std::vector<std::string> warnings;
  expect_ball(normalization_from_masks(set.views, &warnings), ball);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST(Normalize, EmptyMasksAndDisagreeingPosesAreErrors) {
  const TestBall ball;
  const auto views = test_views(ball, 40);
  MaskSet set = ball_masks(ball, views);
  for (auto& m : set.pixels) std::fill(m.begin(), m.end(), uint8_t(0));
  EXPECT_THAT(message([&] { normalization_from_masks(set.views); }), HasSubstr("No mask has a pixel set"));
  set = ball_masks(ball, views);
  for (HullMask& v : set.views) {  // OpenGL axes taken for OpenCV: everything is seen behind the cameras
    for (Vec3d& row : v.camera.world_from_cam.row) row = {row.x, -row.y, -row.z};
  }
  EXPECT_THAT(message([&] { normalization_from_masks(set.views); }), HasSubstr("disagree"));
  set = ball_masks(ball, views);
  for (HullMask& v : set.views) v = set.views[0];
  EXPECT_THAT(message([&] { normalization_from_masks(set.views); }), HasSubstr("several sides"));
  set = ball_masks(ball, views);
  for (HullMask& v : set.views) v.camera.center.x = NAN;
  EXPECT_NE(message([&] { normalization_from_masks(set.views); }), "no error");
  EXPECT_THAT(message([&] { normalization_from_masks(std::span(set.views).first(1)); }),
              HasSubstr("at least two"));
}

TEST(Normalize, NearestPointToLines) {
  const Vec3d p{1, 2, 3};
  std::vector<Vec3d> directions{normalize(Vec3d{1, 0, 0.1}), normalize(Vec3d{0, 1, 0.3}),
                                normalize(Vec3d{1, 1, 1})},
      origins;
  for (const Vec3d d : directions) origins.push_back(p - d * 7.0);
  EXPECT_NEAR(length(nearest_point_to_lines(origins, directions) - p), 0, 1e-10);
}

TEST(Normalize, FromFiles) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path(), "train", ball, test_views(ball, 30));
  expect_ball(find_normalization(load_capture(temp.path())), ball);
  for (const View& v : load_capture(temp.path()).views) write_png(v.image_path, Image(64, 48, 3, 0.5f));
  EXPECT_THAT(message([&] { find_normalization(load_capture(temp.path())); }),
              HasSubstr("neither masks nor an alpha"));
}

// The sample was rendered with the object in the unit sphere, bounding radius 0.97. Hulls are a little
// larger.
TEST(Normalize, SampleCapture) {
  const Normalization n = find_normalization(load_capture(source_file("samples/spot")));
  EXPECT_NEAR(n.scale, 0.9 / 0.97, 0.06);
  EXPECT_LT(length(n.center), 0.15);
}

}  // namespace
}  // namespace cei3d
