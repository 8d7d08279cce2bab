// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/view_brightness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr size_t kViews = 12;

float true_factor(size_t view) { return std::exp(0.1f * std::sin(float(view) * 2.1f)); }

// A ball, half of which each view shows; its photographs are brighter by their factors. bad: of the
// reflections that light and material do not explain, on its upper quarter, different from view to view.
std::vector<ComparedSample> photographed(float bad) {
  Rng rng(7, 0, 0);
  std::vector<ComparedSample> out;
  for (size_t view = 0; view < kViews; ++view) {
    const Vec3f from = fibonacci_direction(int(view), int(kViews));
    for (int i = 0; i < 6000; ++i) {
      const Vec3f p = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
      if (dot(p, from) < 0.1f) continue;
      const Vec3f radiance = Vec3f{0.3f, 0.2f, 0.1f} * (1 + 0.3f * p.x);
      // The albedo of the front is too dark in all views.
      Vec3f photo = radiance * (true_factor(view) * (p.y > 0 ? 1.2f : 1.0f) * (1 + 0.05f * rng.normal()));
      if (p.z > 0.5f) photo = photo * (1 + bad * rng.uniform() * float(view % 3));
      out.push_back({p * 0.8f, uint16_t(view), photo, radiance});
    }
  }
  return out;
}

double worst_error(const std::vector<float>& factors) {
  double mean = 0, worst = 0;
  for (size_t v = 0; v < kViews; ++v) mean += std::log(true_factor(v)) / double(kViews);
  for (size_t v = 0; v < kViews; ++v)
    worst = std::max(worst, std::abs(std::log(factors[v]) - std::log(true_factor(v)) + mean));
  return worst;
}

// Noise of 5 % in parts of some tens of samples leaves about .01.
TEST(ViewBrightness, IsTheFactorOfThePhotographs) {
  EXPECT_LT(worst_error(view_brightness(photographed(0), kViews)), 0.02);
}

TEST(ViewBrightness, DoesNotFollowAPartThatIsExplainedBadly) {
  EXPECT_LT(worst_error(view_brightness(photographed(0.8f), kViews)), 0.03);
}

TEST(ViewBrightness, IsOneWhereAPhotographShowsNothing) {
  std::vector<ComparedSample> samples = photographed(0);
  std::erase_if(samples, [](const ComparedSample& s) { return s.view == 3; });
  for (ComparedSample& s : samples) s.photo = s.radiance;
  for (const float f : view_brightness(samples, kViews)) EXPECT_NEAR(f, 1, 1e-5f);
  for (const float f : view_brightness({}, 2)) EXPECT_EQ(f, 1);
}

}  // namespace
}  // namespace cei3d
