// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/ray_votes.h"

#include <gtest/gtest.h>

#include "engine/capture/test_moved.h"

namespace cei3d {
namespace {

constexpr int kSize = 128, kVoters = 24;

SmallMasks body_masks() { return moved_masks(kVoters, 0, kSize, kKnob); }

// Seen from a direction that no voter has.
Camera asking_camera() { return spread_cameras(7, lens_of_size(kSize, kSize))[3]; }

bool sees_object(const Camera& camera, Vec3d p) {
  const Vec3d direction = normalize(p - camera.center);
  for (const Ball& b : {kBody, kKnob}) {
    const auto [near, far] = sphere_span(camera.center - b.center, direction, b.radius);
    if (near < far) return true;
  }
  return false;
}

// How many of the cameras look past the balls at the best place of the ray, by the balls themselves.
size_t fewest_against(const Camera& own, int x, int y, const std::vector<Camera>& cameras) {
  const Ray ray = own.ray(x + 0.5, y + 0.5);
  const Vec3d origin = to_double(ray.origin), direction = to_double(ray.direction);
  const auto [first, last] = sphere_span(origin, direction, 1.0);
  size_t fewest = cameras.size();
  for (double t = first; t < last; t += 1e-3) {
    size_t against = 0;
    for (const Camera& c : cameras) against += !sees_object(c, origin + direction * t);
    fewest = std::min(fewest, against);
  }
  return fewest;
}

TEST(RayVotes, CountsTheViewsThatLookPast) {
  const SmallMasks masks = body_masks();
  const Camera own = asking_camera();
  const RayVotes votes(masks.views(), own);
  int differing = 0, rays = 0, past = 0;
  for (int y = 4; y < kSize; y += 8)
    for (int x = 4; x < kSize; x += 8) {
      const Ray ray = own.ray(x + 0.5, y + 0.5);
      const auto [first, last] = sphere_span(to_double(ray.origin), to_double(ray.direction), 1.0);
      if (last - first < 0.5) continue;
      const size_t exact = fewest_against(own, x, y, masks.cameras);
      const size_t found = votes.against(x, y, 0, kVoters);
      differing += found + 1 < exact || exact + 1 < found;  // one more or less by the pixels of the masks
      past += exact > 2;
      ++rays;
    }
  EXPECT_GT(past, 20);
  EXPECT_GT(rays - past, 20);
  EXPECT_LE(differing, rays / 20);
}

TEST(RayVotes, EndsWhereItIsAsked) {
  const SmallMasks masks = body_masks();
  const Camera own = asking_camera();
  const RayVotes votes(masks.views(), own);
  const int middle = kSize / 2;
  EXPECT_EQ(votes.against(middle, middle, 0, 5), 0u);
  EXPECT_EQ(votes.against(middle, middle, 3, 5), 3u);  // as few as asked for
  EXPECT_GT(votes.against(8, middle, 0, kVoters), 5u);
  EXPECT_EQ(votes.against(8, middle, 0, 5), 6u);  // more than asked for
  EXPECT_TRUE(votes.meets_object(middle, middle, 0));
  EXPECT_FALSE(votes.meets_object(8, middle, 5));
}

TEST(RayVotes, UnknownPixelsHaveNoVote) {
  SmallMasks masks = body_masks();
  const Camera own = asking_camera();
  const int middle = kSize / 2;
  for (size_t v = 0; v < masks.masks.size(); ++v)
    if (v % 4 != 0) masks.masks[v].assign(masks.masks[v].size(), kUnknown);
  const RayVotes quarter(masks.views(), own);
  EXPECT_FALSE(quarter.meets_object(middle, middle, 0));  // fewer than a third of the views see anything
  EXPECT_EQ(quarter.against(middle, middle, 0, kVoters), 0u);
  // A quarter of the few that see a place rules the object out there, and no more is known.
  EXPECT_EQ(quarter.against(8, middle, 0, kVoters), size_t(kVoters) + 1);
}

TEST(RayVotes, OneViewMayAlwaysBeWrong) {
  const SmallMasks masks = body_masks();
  const RayVotes votes(masks.views(), asking_camera());
  EXPECT_EQ(votes.allowed(0.01), 1u);
  EXPECT_EQ(votes.allowed(0.25), size_t(kVoters) / 4);
}

}  // namespace
}  // namespace cei3d
