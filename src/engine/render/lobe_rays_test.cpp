// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lobe_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/reflection.h"
#include "engine/render/hit_reflection.h"

namespace cei3d {
namespace {

const Vec3f kNormal{0, 0, 1};

Hit hit_seen_at(float degrees, Vec3f position = {0.1f, 0.2f, 0.3f}) {
  const float a = degrees * kPi / 180;
  return {position, kNormal, {std::sin(a), 0, std::cos(a)}, 0, 0, 0};
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

// Median distances of the rays from the lobe's axis, in the plane of incidence (y = 0) and across it.
struct Spread {
  double along, across;
};
Spread spread_of(const Hit& h, const Material& m) {
  const LobeRays lobe(h, m);
  const Vec3f axis = mean_lobe(reflection_of(h, m)).axis, along = cross(Vec3f{0, 1, 0}, axis);
  std::vector<double> x, y;
  for (const Vec2f p : lobe_points(4000)) {
    const Vec3f d = lobe.at(p);
    EXPECT_NEAR(dot(d, d), 1, 1e-5);
    EXPECT_GE(d.z, -1e-6);
    x.push_back(std::abs(double(dot(d, along))));
    y.push_back(std::abs(double(d.y)));
  }
  return {median(x), median(y)};
}

TEST(LobeRays, AreAsWideAndAsLongAsTheLobe) {
  const Material m{0.2f, 0.5f, 1};
  for (const float degrees : {0.0f, 40.0f, 65.0f}) {
    const Hit h = hit_seen_at(degrees);
    const LobeFrame<float> lobe = mean_lobe(reflection_of(h, m));
    const Spread got = spread_of(h, m);
    // Half of 1 / (1 + r^2)^2 lies at most 3^-1/2 from a line through its middle, which is the tangent of
    // half an angle.
    const double width = 2 / std::sqrt(3.0) * reflection_half_energy(double(lobe.roughness));
    EXPECT_NEAR(got.along / got.across, lobe.stretch, 0.03 * lobe.stretch) << degrees;
    EXPECT_NEAR(got.along * got.across, width * width, 0.06 * width * width) << degrees;
  }
}

TEST(LobeRays, AreTurnedFromHitToHitAndTheSameForTheSame) {
  const Material m{0.3f, 0.5f, 1};
  const Vec2f p = lobe_points(10)[5];
  const auto at = [&](Vec3f position) { return LobeRays(hit_seen_at(30, position), m).at(p); };
  const Vec3f one = at({0.1f, 0.2f, 0.3f}), same = at({0.1f, 0.2f, 0.3f}), other = at({0.1f, 0.2f, 0.301f});
  EXPECT_EQ(dot(one - same, one - same), 0);
  EXPECT_GT(dot(one - other, one - other), 1e-4);
}

TEST(LobeRays, AreMoreForRoughMetalsThanForFaintReflections) {
  EXPECT_EQ(lobe_ray_count({0.6f, 0.1f, 0}, 0.9f), kMinLobeRays);
  EXPECT_GT(lobe_ray_count({0.3f, 0.5f, 1}, 0.9f), lobe_ray_count({0.1f, 0.5f, 1}, 0.9f));
}

}  // namespace
}  // namespace cei3d
