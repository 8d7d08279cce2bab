// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/object_masks.h"

#include <gtest/gtest.h>

#include "core/base/temp_folder.h"
#include "engine/io/image_file.h"
#include "engine/photos/test_table.h"

namespace cei3d {
namespace {

TEST(SplitPoints, TellsTheObjectFromItsTableAndTheRoom) {
  const TestTable t = test_table();
  const SparsePoints points = sparse_points(t.views);
  const PointSplit split = split_points(points, t.views);
  EXPECT_TRUE(split.on_plane);
  EXPECT_LT(length(split.center - t.ball), 0.02);
  size_t right = 0, wrong = 0;
  for (size_t i = 0; i < points.positions.size(); ++i) {
    const Vec3d p = points.positions[i];
    const bool on_ball = std::abs(length(p - t.ball) - t.radius) < 1e-6 && p.z > 0.04;
    if (split.belief[i] == 0) continue;
    (split.belief[i] > 0) == on_ball ? ++right : ++wrong;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(right, 0.9 * double(points.positions.size()));
}

TEST(SplitPoints, NeedsPhotographsFromSeveralSides) {
  TestTable t = test_table();
  for (View& v : t.views) v.camera.world_from_cam = t.views[0].camera.world_from_cam;
  EXPECT_THROW(split_points(sparse_points(t.views), t.views), Error);
}

double overlap(const TestTable& t, const View& view, const Image& mask) {
  double both = 0, either = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const bool want = sees_ball(t, view.camera, {x + 0.5, y + 0.5}), have = *mask.at(x, y) > 0.5f;
      both += want && have, either += want || have;
    }
  return both / either;
}

double worst_overlap(const TestTable& t, const std::filesystem::path& masks) {
  double worst = 1;
  for (const View& v : t.views) worst = std::min(worst, overlap(t, v, read_image(masks / (v.name + ".png"))));
  return worst;
}

MaskRequest request_for(const TestTable& t, const TempFolder& folder) {
  return {t.views, {}, folder.path() / "first", folder.path() / "masks"};
}

TEST(ObjectMasks, AreFoundWithoutClicks) {
  const TestTable t = test_table();
  const TempFolder folder;
  TrueSegmenter segmenter(t);
  Progress progress;
  EXPECT_TRUE(make_masks(request_for(t, folder), segmenter, 0, 1, progress).empty());
  EXPECT_GT(worst_overlap(t, folder.path() / "masks"), 0.99);
  for (const Prompts& p : segmenter.asked) EXPECT_FALSE(p.positive.empty());
}

// A segmenter that takes the background for the object in every tenth photograph is overruled by the others.
TEST(ObjectMasks, OfOnePhotographDoNotSpoilTheOthers) {
  const TestTable t = test_table();
  const TempFolder folder;
  TrueSegmenter segmenter(t);
  segmenter.wrong = 10;
  Progress progress;
  make_masks(request_for(t, folder), segmenter, 0, 1, progress);
  EXPECT_LT(worst_overlap(t, folder.path() / "first"), 0.1);
  EXPECT_GT(worst_overlap(t, folder.path() / "masks"), 0.95);
}

TEST(ObjectMasks, BeginWithTheClickedPhotograph) {
  const TestTable t = test_table();
  const TempFolder folder;
  TrueSegmenter segmenter(t);
  MaskRequest request = request_for(t, folder);
  request.clicks = {{5, {60, 45}, true}, {5, {10, 80}, false}};
  Progress progress;
  make_masks(request, segmenter, 0, 1, progress);
  ASSERT_FALSE(segmenter.asked.empty());
  EXPECT_EQ(segmenter.asked[0].positive.size(), 1u);
  EXPECT_EQ(segmenter.asked[0].negative.size(), 1u);
  EXPECT_EQ(segmenter.asked[0].positive[0].x, 60);
  EXPECT_GT(worst_overlap(t, folder.path() / "masks"), 0.99);
}

TEST(ObjectMasks, GoOnWithWhatIsThere) {
  const TestTable t = test_table();
  const TempFolder folder;
  TrueSegmenter first(t), second(t);
  Progress progress;
  make_masks(request_for(t, folder), first, 0, 1, progress);
  const std::filesystem::path lost = folder.path() / "masks/photo_7.png";
  const Image before = read_image(lost);
  std::filesystem::remove(lost);
  make_masks(request_for(t, folder), second, 0, 1, progress);
  EXPECT_EQ(second.asked.size(), 1u);
  EXPECT_EQ(read_image(lost).data, before.data);
}

// Knows what draws the eye, too.
class SeeingSegmenter final : public PhotoSegmenter {
 public:
  explicit SeeingSegmenter(const TestTable& t) : truth(t), table_(t) {}
  Image log_odds(const View& view, const PixelBox& section, const Prompts& prompts,
                 const std::optional<PixelBox>& around) override {
    if (first_height == 0 && around) first_height = around->height;
    return truth.log_odds(view, section, prompts, around);
  }
  // Half as large as the photograph.
  std::optional<Image> saliency(const View& view) override {
    if (!has_saliency) return std::nullopt;
    Image out(view.camera.width / 2, view.camera.height / 2, 1);
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x)
        *out.at(x, y) = sees_ball(table_, view.camera, {2 * x + 1.0, 2 * y + 1.0}) ? 0.9f : 0.1f;
    return out;
  }
  TrueSegmenter truth;
  bool has_saliency = true;
  int first_height = 0;  // of the box around the object in the first photograph, in pixels

 private:
  const TestTable& table_;
};

// Where an object has no texture around its middle, its points are two groups, of which only one is taken for
// the object. What draws the eye joins them.
TEST(ObjectMasks, AnObjectOfTwoGroupsOfPointsIsOneBySaliency) {
  TestTable t = test_table();
  std::erase_if(t.on_ball, [](Vec3d p) { return p.z > 0.2 && p.z < 0.8; });
  add_sightings(t);
  const double diameter = 2 * t.radius * t.views[0].camera.fy / 3;  // pixels, from 3 units away
  for (const bool has_saliency : {false, true}) {
    const TempFolder folder;
    SeeingSegmenter segmenter(t);
    segmenter.has_saliency = has_saliency;
    Progress progress;
    make_masks(request_for(t, folder), segmenter, 0, 1, progress);
    EXPECT_GT(segmenter.first_height, 0);
    EXPECT_EQ(segmenter.first_height > 0.8 * diameter, has_saliency) << segmenter.first_height;
  }
}

// The plate shows a texture; the photograph the same with noise and a disc on it.
TEST(PlateSegmenter, FindsWhatDiffers) {
  const TempFolder folder;
  Image plate(80, 60, 3), photo(80, 60, 3);
  Rng rng(3, 0, 0);
  const auto on_disc = [](int x, int y) { return std::hypot(x - 45.0, y - 30.0) < 15; };
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      for (int c = 0; c < 3; ++c) {
        const float texture = 0.4f + 0.3f * float((x / 7 + y / 5) % 2) + 0.02f * float(c);
        plate.at(x, y)[c] = texture;
        photo.at(x, y)[c] = on_disc(x, y) ? (c == 0 ? 0.8f : 0.2f) : texture + 0.01f * (rng.uniform() - 0.5f);
      }
  write_png(folder.path() / "plate.png", plate);
  write_png(folder.path() / "photo.png", photo);
  View view;
  view.name = "photo", view.image_path = folder.path() / "photo.png";
  view.camera.width = 80, view.camera.height = 60;
  const Image odds =
      plate_segmenter(folder.path() / "plate.png")->log_odds(view, {10, 5, 60, 50}, {}, std::nullopt);
  ASSERT_EQ(odds.width, 60);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) EXPECT_EQ(*odds.at(x, y) > 0, on_disc(x + 10, y + 5)) << x << " " << y;
}

}  // namespace
}  // namespace cei3d
