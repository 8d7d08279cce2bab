// SPDX-License-Identifier: Apache-2.0
// A ball whose field is too steep away from it, as trained fields are: nothing holds their slope there.
#include "engine/reconstruct/geometry/occupancy.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.5f;

float steep_ball(Vec3f p) {
  const float d = length(p) - kRadius;
  return d < 0.05f ? d : 0.05f + 1.5f * (d - 0.05f);
}

OccupancyGrid grid_of_ball() {
  OccupancyGrid grid;
  const int n = grid.resolution();
  std::vector<float> values(size_t(n) * n * n);
  for (size_t i = 0; i < values.size(); ++i) values[i] = steep_ball(grid.center(int(i)));
  grid.set(values);
  return grid;
}

// Checks the samples of rays that meet the ball, and returns how many there are.
size_t expect_samples_on_both_sides(float slack) {
  constexpr float kStep = 0.004f, kBand = 0.006f;
  const OccupancyGrid grid = grid_of_ball();
  std::vector<Ray> rays;
  std::vector<float> jitter;
  for (int i = 0; i < 2000; ++i) {
    Rng rng(5, 0, uint64_t(i));
    const auto uniform = [&] { return 2 * rng.uniform() - 1; };
    const Vec3f origin = normalize(Vec3f{uniform(), uniform(), uniform()}) * 3.0f;
    const Vec3f target = Vec3f{uniform(), uniform(), uniform()} * 0.25f;
    rays.push_back({origin, normalize(target - origin)});
    jitter.push_back(rng.uniform());
  }
  std::vector<float> all;
  std::vector<int> counts(rays.size());
  grid.march(rays, {kStep, kBand, slack}, jitter, all, counts);
  size_t first = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const std::span depths(&all[first], size_t(counts[i]));
    first += depths.size();
    size_t behind = 0;
    while (behind < depths.size() && steep_ball(rays[i].origin + rays[i].direction * depths[behind]) > 0)
      ++behind;
    if (behind == 0 || behind == depths.size()) {
      ADD_FAILURE() << "ray " << i << ": " << behind << " of " << depths.size() << " samples are outside";
      continue;
    }
    EXPECT_LT(depths[behind] - depths[behind - 1], 1.01f * kStep) << "ray " << i;
    for (const float depth : {depths.front(), depths.back()})
      EXPECT_LT(std::abs(steep_ball(rays[i].origin + rays[i].direction * depth)),
                kBand + slack * grid.half_diagonal() + kStep)
          << "ray " << i;
  }
  EXPECT_EQ(first, all.size());
  return all.size();
}

TEST(OccupancyGrid, EveryRayThatMeetsTheSurfaceIsSampledOnBothSidesOfIt) {
  const size_t distrustful = expect_samples_on_both_sides(1);
  EXPECT_LT(expect_samples_on_both_sides(0.25f), 0.7 * double(distrustful));
}

TEST(OccupancyGrid, RaysThatPassFarFromTheSurfaceAreNotSampled) {
  std::vector<float> depths;
  int count = -1;
  const Ray ray{{0.8f, 0, -3}, {0, 0, 1}};
  const float jitter = 0.5f;
  grid_of_ball().march({&ray, 1}, {0.004f, 0.006f}, {&jitter, 1}, depths, {&count, 1});
  EXPECT_TRUE(depths.empty());
  EXPECT_EQ(count, 0);
}

Field sphere_field() {
  FieldConfig config;
  config.outputs = 1;
  config.sphere_radius = 0.5f;
  return {config, 3};
}

TEST(OccupancyGrid, ARefreshPutsTheFieldsDistanceIntoEveryCellWithinTheMargin) {
  const Field sdf = sphere_field();
  const Device device = make_device("cpu");
  OccupancyGrid grid(32);
  const float before = grid.at({0, 0, 0});
  grid.refresh(device, sdf, 0.1f);
  EXPECT_EQ(grid.at({0, 0, 0}), before) << "far from the surface as last asked";
  grid.refresh(device, sdf, 1e9f);
  const std::vector<float> values = grid.values();
  std::vector<Vec3f> centers;
  for (int i = 0; i < int(values.size()); ++i) centers.push_back(grid.center(i));
  const std::vector<float> truth = first_output(device, sdf, centers);
  for (size_t i = 0; i < values.size(); ++i) {
    if (dot(centers[i], centers[i]) > 1.1f) continue;  // beyond the unit sphere nothing is asked
    ASSERT_NEAR(values[i], truth[i], 1e-4f) << "cell " << i;
  }
}

class StopsAt : public Progress {
 public:
  explicit StopsAt(int check) : check_(check) {}
  int checks() const { return checks_; }

 private:
  bool is_cancelled() const override { return ++checks_ >= check_; }
  int check_;
  mutable int checks_ = 0;
};

TEST(OccupancyGrid, AnInterruptedRefreshChangesNothing) {
  const Field sdf = sphere_field();
  const Device device = make_device("cpu");
  OccupancyGrid grid(64);
  const std::vector<float> before = grid.values();
  const StopsAt third(3), never(1000);
  EXPECT_THROW(grid.refresh(device, sdf, 1e9f, third), Error);
  EXPECT_EQ(grid.values(), before);
  grid.refresh(device, sdf, 1e9f, never);
  EXPECT_NE(grid.values(), before);
  // The cells of the unit sphere are more than half of all; 40000 take the largest networks 5 s of one core.
  EXPECT_GE(never.checks(), 64 * 64 * 64 / 2 / 40000 + 1);
}

TEST(OccupancyGrid, ValuesComeBackInTheirOrder) {
  OccupancyGrid grid(8);
  std::vector<float> values(8 * 8 * 8);
  for (size_t i = 0; i < values.size(); ++i) values[i] = float(i) / 1024 - 0.2f;
  grid.set(values);
  const std::vector<float> back = grid.values();
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(back[i], values[i], 1e-4f);
    EXPECT_EQ(grid.at(grid.center(int(i))), back[i]);
  }
}

}  // namespace
}  // namespace cei3d
