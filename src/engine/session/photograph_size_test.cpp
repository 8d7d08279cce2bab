// SPDX-License-Identifier: Apache-2.0
#include "engine/session/photograph_size.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

CaptureReport report_of(int views, ImageSize size, double coverage) {
  CaptureReport report;
  report.splits.push_back({Split::test, 200, {8000, 6000}, false, 0.9, 0.9, 0.9});
  report.splits.push_back({Split::train, views, size, false, coverage, coverage, coverage});
  return report;
}

TEST(PhotographSize, LargePhotographsAreUsedSmaller) {
  EXPECT_EQ(default_downscale(report_of(100, {512, 512}, 0.4)), 1);
  EXPECT_EQ(default_downscale(report_of(100, {800, 800}, 0.9)), 1);
  EXPECT_EQ(default_downscale(report_of(100, {4000, 3000}, 0.4)), 3);
  EXPECT_EQ(default_downscale({}), 1);
  for (const double coverage : {0.05, 0.2, 0.5, 0.9}) {
    const int n = default_downscale(report_of(80, {6000, 4000}, coverage));
    EXPECT_LE(80 * 24e6 * coverage / (n * n), 60e6) << coverage;
    EXPECT_GT(80 * 24e6 * coverage / ((n - 1) * (n - 1)), 60e6) << coverage;
  }
}

TEST(PhotographSize, MemoryGrowsWithThePixelsThatAreUsed) {
  const CaptureReport report = report_of(100, {4000, 3000}, 0.4);
  EXPECT_GT(reconstruction_gib(report, 1), 8);
  EXPECT_LT(reconstruction_gib(report, 3), 3);
  EXPECT_LT(reconstruction_gib(report, 4), reconstruction_gib(report, 3));
}

}  // namespace
}  // namespace cei3d
