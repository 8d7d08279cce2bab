// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/mask_votes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/capture/test_balls.h"
#include "engine/synthetic/picture.h"
#include "engine/synthetic/shapes.h"
#include "engine/synthetic/views.h"

namespace cei3d {
namespace {

// The teapot of the unit frame, whose handle can be seen through.
class MaskVotes : public testing::Test {
 protected:
  static constexpr int kSize = 96, kViews = 40;
  static void SetUpTestSuite() {
    const Shape teapot = teapot_shape();
    for (const Camera& c : spread_cameras(kViews, lens_of_size(kSize, kSize))) {
      masks_.cameras.push_back(c);
      const Image drawn = draw_unlit(*teapot.body, c, [](Vec3f) { return Vec3f{1, 1, 1}; });
      std::vector<uint8_t> mask;
      for (size_t i = 3; i < drawn.data.size(); i += 4)
        mask.push_back(drawn.data[i] > 0.5f ? kObject : kBackground);
      masks_.masks.push_back(std::move(mask));
    }
  }
  static void TearDownTestSuite() { masks_ = {}; }
  // What the votes say after mask 7 was changed at the pixels within a disc.
  static std::vector<MaskDoubt> votes_after(double x0, double y0, double radius, uint8_t value,
                                            Area& changed) {
    SmallMasks m = masks_;
    changed.assign(m.masks[7].size(), 0);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        uint8_t& pixel = m.masks[7][size_t(y) * kSize + x];
        if (std::hypot(x - x0, y - y0) > radius || pixel == value) continue;
        changed[size_t(y) * kSize + x] = 1;
        pixel = value;
      }
    return vote_on_masks(m);
  }
  static SmallMasks masks_;
};
SmallMasks MaskVotes::masks_;

TEST_F(MaskVotes, TrueMasksStandForThemselves) {
  for (const MaskDoubt& d : vote_on_masks(masks_)) EXPECT_FALSE(d.stands_out) << d.missing << " " << d.extra;
}

TEST_F(MaskVotes, AHoleThatOnlyOneMaskHasIsDoubted) {
  Area hole;
  const std::vector<MaskDoubt> doubts = votes_after(46, 50, 9, kBackground, hole);
  for (size_t i = 0; i < doubts.size(); ++i) EXPECT_EQ(doubts[i].stands_out, i == 7);
  EXPECT_GT(share_of(doubts[7].doubtful, hole), 0.9);
  EXPECT_GT(share_of(hole, doubts[7].doubtful), 0.8);
}

TEST_F(MaskVotes, MatterThatOnlyOneMaskHasIsDoubted) {
  Area blob;
  const std::vector<MaskDoubt> doubts = votes_after(10, 10, 9, kObject, blob);
  for (size_t i = 0; i < doubts.size(); ++i) EXPECT_EQ(doubts[i].stands_out, i == 7);
  EXPECT_GT(share_of(doubts[7].doubtful, blob), 0.9);
}

TEST(SmallMasks, KeepWhatIsUnknown) {
  Camera c;
  c.width = 8, c.height = 4, c.fx = c.fy = 8, c.cx = 4, c.cy = 2;
  std::vector<uint8_t> mask(32, kObject);
  mask[9] = kUnknown;
  const SmallMasks small = small_masks(std::vector<HullMask>{{c, mask}}, Normalization(), 4);
  EXPECT_EQ(small.cameras[0].width, 4);
  EXPECT_EQ(small.masks[0], (std::vector<uint8_t>{kUnknown, 1, 1, 1, 1, 1, 1, 1}));
}

// Of three views of one camera two are large; a view of another camera is judged at its own size.
TEST(SmallMasks, OfOneCameraHaveOneScaleHoweverTheyAreCropped) {
  const int sides[] = {8, 8, 4, 4};
  const double focal[] = {8, 8, 8, 4};
  std::vector<std::vector<uint8_t>> pixels;
  std::vector<HullMask> masks;
  pixels.reserve(4);
  for (size_t i = 0; i < 4; ++i) {
    Camera c;
    c.width = c.height = sides[i], c.fx = c.fy = focal[i], c.cx = c.cy = sides[i] / 2.0;
    pixels.emplace_back(size_t(sides[i] * sides[i]), kObject);
    masks.push_back({c, pixels.back()});
  }
  const SmallMasks small = small_masks(masks, Normalization(), 4);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(small.cameras[i].fx, 4) << i;
  EXPECT_EQ(small.cameras[2].width, 2);
  EXPECT_EQ(small.masks[2].size(), 4u);
  EXPECT_EQ(small.cameras[3].width, 4);
}

}  // namespace
}  // namespace cei3d
