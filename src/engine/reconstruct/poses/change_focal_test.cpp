// SPDX-License-Identifier: Apache-2.0
// Pictures of a checkered box by cameras whose focal length is given a little wrong, or right, beside a model
// that is the box.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/reconstruct/poses/align_views.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

constexpr int kViews = 16, kSize = 96;
constexpr double kMissing = 1.02;  // factor on the focal length as it is given
constexpr FocalPrior kPrior{0.02};
constexpr double kBound = 0.005;  // within which a factor of views of so few pixels is found

Vec3f checkers(Vec3f p) {
  const bool odd = (int(std::floor(p.x * 5)) + int(std::floor(p.y * 5)) + int(std::floor(p.z * 5))) & 1;
  return odd ? Vec3f{0.5f, 0.3f, 0.2f} : Vec3f{0.1f, 0.3f, 0.4f};
}

// farther: by which a longer lens makes up.
std::vector<Camera> true_cameras(double farther = 1) {
  std::vector<Camera> cameras;
  for (int v = 0; v < kViews; ++v)
    cameras.push_back(dolly_zoomed(box_camera(-0.6 + 1.4 * v / kViews, 2.4 * v, kSize), farther));
  return cameras;
}

// These cameras as they are given: with a focal length that lacks a factor, and moved by chance.
std::vector<Camera> given_cameras(std::vector<Camera> cameras, double missing, double disturbance) {
  for (size_t v = 0; v < cameras.size(); ++v) {
    Rng rng(3, 1, v);
    const auto vector = [&] { return Vec3d{rng.normal(), rng.normal(), rng.normal()} * disturbance; };
    const Vec3d turn = vector(), shift = vector();
    cameras[v] = zoomed(moved(cameras[v], {turn, shift}), 1 / missing);
  }
  return cameras;
}

PixelStore photographs(const std::vector<Camera>& truth, const std::vector<Camera>& given) {
  PixelStore store;
  for (size_t v = 0; v < truth.size(); ++v)
    store.add_view(given[v], filtered_box_picture(truth[v], checkers), 6);
  return store;
}

// What a model shows that is `size` times as large as the box: the box from as many times as near.
ModelView model_from(Camera camera, double size) {
  camera.center = camera.center / size;
  const Image rgba = filtered_box_picture(camera, checkers);
  ModelView view{Image(kSize, kSize, 3), Image(kSize, kSize, 1)};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float* p = rgba.at(x, y);
      for (int c = 0; c < 3; ++c) view.srgb.at(x, y)[c] = srgb_from_linear(p[c]) * p[3] + 1 - p[3];
      *view.depth.at(x, y) = std::max(float(size) * pit_box().cast(camera.ray(x + 0.5, y + 0.5)), 0.0f);
    }
  return view;
}

AlignedViews aligned_with_box(const PixelStore& store, double size, const FocalPrior& prior) {
  ShownViews views;
  views.reductions.assign(kViews, 1);
  views.photographs = photographs_over_white(store, views.reductions);
  for (const Camera& c : store.cameras()) views.models.push_back(model_from(c, size));
  return align_views(views, store, prior);
}

TEST(ChangeFocal, FindsWhatIsMissingAlsoWherePosesAreWrong) {
  const std::vector<Camera> truth = true_cameras();
  for (const double missing : {kMissing, 1 / kMissing})
    for (const double disturbance : {0.0, 0.006}) {
      const PixelStore store = photographs(truth, given_cameras(truth, missing, disturbance));
      const AlignedViews found = aligned_with_box(store, 1, kPrior);
      EXPECT_NEAR(found.focal, missing, kBound) << disturbance;
      EXPECT_NEAR(found.cameras[5].fx, found.focal * store.cameras()[5].fx, 1e-9);
    }
}

// Trained with a focal length that is too short, a model is too large, and explains nearly all. The cameras
// stood where they were given: the step away from the object that makes up for it is taken back.
TEST(ChangeFocal, IsFoundByAModelThatMadeUpForIt) {
  const std::vector<Camera> truth = true_cameras();
  const AlignedViews found =
      aligned_with_box(photographs(truth, given_cameras(truth, kMissing, 0)), 1.0165, kPrior);
  EXPECT_NEAR(found.focal, kMissing, kBound);
  for (size_t v = 0; v < truth.size(); ++v)
    EXPECT_LT(length(found.cameras[v].center - truth[v].center), 0.02) << v;
}

TEST(ChangeFocal, LeavesOneThatIsRight) {
  const std::vector<Camera> truth = true_cameras();
  EXPECT_EQ(aligned_with_box(photographs(truth, truth), 1, kPrior).focal, 1);
  const PixelStore moved_by_chance = photographs(truth, given_cameras(truth, 1, 0.006));
  EXPECT_NEAR(aligned_with_box(moved_by_chance, 1, kPrior).focal, 1, kBound);
}

// Without perspective, a longer lens and a larger object look the same.
TEST(ChangeFocal, LeavesOneThatNothingTells) {
  const std::vector<Camera> truth = true_cameras(400);
  const PixelStore store = photographs(truth, given_cameras(truth, kMissing, 0));
  EXPECT_EQ(aligned_with_box(store, kMissing, kPrior).focal, 1);
}

TEST(ChangeFocal, LeavesOneThatIsBelieved) {
  const std::vector<Camera> truth = true_cameras();
  const PixelStore store = photographs(truth, given_cameras(truth, kMissing, 0));
  EXPECT_EQ(aligned_with_box(store, 1, {}).focal, 1);
}

}  // namespace
}  // namespace cei3d
