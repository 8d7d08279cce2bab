// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/coverage.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/error.h"

namespace cei3d {
namespace {
using testing::AllOf;
using testing::HasSubstr;

TEST(SeenSides, IsTheAreaOfCaps) {
  const double cap = (1 - std::cos(kSeenWithin * kPi / 180)) / 2;  // of the sphere
  const std::vector<Vec3d> one{{0, 0, 1}};
  EXPECT_NEAR(seen_sides(one).share, cap, 2e-3);
  EXPECT_NEAR(seen_sides(one).gap, 180, 3);
  EXPECT_LT(seen_sides(one).unseen.z, -0.99);
  const std::vector<Vec3d> axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  EXPECT_NEAR(seen_sides(axes).share, 6 * cap, 4e-3);
  EXPECT_NEAR(seen_sides(axes).gap, std::acos(1 / std::sqrt(3.0)) * 180 / kPi, 3);  // at (1, 1, 1)
  EXPECT_NEAR(seen_sides(axes, [](Vec3d d) { return d.z > 0.999; }).share, 1, 0);
}

// n cameras at a height (sine of the elevation) and azimuths from a to b degrees, about the origin.
void add_ring(Capture& c, int n, double a, double b, double sine) {
  for (int i = 0; i < n; ++i) {
    const double phi = (a + (b - a) * (i + 0.5) / n) * kPi / 180, r = std::sqrt(1 - sine * sine);
    View v;
    v.name = fmt::format("r_{:.0f}", phi * 180 / kPi);
    v.camera.center = Vec3d{r * std::cos(phi), r * std::sin(phi), sine} * 4.0 + Vec3d{1, 2, 3};
    c.views.push_back(v);
  }
}

constexpr Vec3d kCenter{1, 2, 3};

std::vector<Finding> found_in(const Capture& capture) {
  std::vector<Finding> findings;
  check_coverage(capture, kCenter, findings);
  return findings;
}

TEST(Coverage, WholeRingsAreEnough) {
  Capture c;
  add_ring(c, 24, 0, 360, 0.3);
  EXPECT_TRUE(found_in(c).empty());
  // Cameras 15 degrees apart at 17 degrees above the horizontal: straight down is farthest away.
  EXPECT_NEAR(seen_sides(c, kCenter).gap, 90 + std::asin(0.3) * 180 / kPi, 3);
  EXPECT_LT(seen_sides(c, kCenter).unseen.z, -0.99);
}

TEST(Coverage, AMissingSideIsNamedWithTheViewsBesideIt) {
  Capture c;
  add_ring(c, 21, 0, 240, 0.3);
  const std::vector<Finding> findings = found_in(c);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_THAT(findings[0].what,
              AllOf(HasSubstr("side of the object is not photographed"), HasSubstr("between r_234 and r_6")));
  Capture narrow;
  add_ring(narrow, 24, 0, 280, 0.3);
  EXPECT_TRUE(found_in(narrow).empty());
}

// Facades and reliefs are photographed from one side, and meant to be.
TEST(Coverage, OneSideIsANote) {
  Capture c;
  add_ring(c, 12, 0, 100, 0.1);
  add_ring(c, 12, 0, 100, 0.5);
  const std::vector<Finding> findings = found_in(c);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::note);
  EXPECT_THAT(findings[0].what, HasSubstr("one side of the object"));
}

TEST(Coverage, FewViewsAndOtherSplitsDoNotCount) {
  Capture few;
  add_ring(few, 9, 0, 200, 0.3);
  EXPECT_TRUE(found_in(few).empty());
  Capture c;
  add_ring(c, 21, 0, 240, 0.3);
  add_ring(c, 10, 240, 360, 0.3);
  for (size_t i = 21; i < c.views.size(); ++i) c.views[i].split = Split::test;
  EXPECT_EQ(found_in(c).size(), 1u);
  EXPECT_TRUE(found_in(Capture()).empty());
}

}  // namespace
}  // namespace cei3d
