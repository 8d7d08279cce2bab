// SPDX-License-Identifier: Apache-2.0
#include "core/base/time_left.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

constexpr double kJob = 500, kStart = 1000;  // seconds that all of it takes; on the clock

TEST(TimeLeft, OfAnEvenJobIsKnownSoon) {
  TimeLeft left;
  for (double t = 0; t < 10; ++t) EXPECT_LT(left.after(t / kJob, kStart + t), 0) << t;
  for (double t = 11; t <= kJob; ++t) EXPECT_NEAR(left.after(t / kJob, kStart + t), kJob - t, 1e-6) << t;
}

TEST(TimeLeft, WhatWasDoneBeforeAJobWasResumedDoesNotCount) {
  TimeLeft left;
  EXPECT_LT(left.after(0, kStart), 0);  // it reads files for two seconds
  constexpr double kThere = 0.47 * kJob;
  for (double t = 0; t < 10; ++t) EXPECT_LT(left.after((kThere + t) / kJob, kStart + 2 + t), 0) << t;
  for (double t = 11; t + kThere <= kJob; ++t)
    EXPECT_NEAR(left.after((kThere + t) / kJob, kStart + 2 + t), kJob - kThere - t, 1e-6) << t;
}

TEST(TimeLeft, OfAJobOfFewStepsIsKnownAfterTwo) {
  TimeLeft left;
  for (int step = 0; step < 2; ++step) EXPECT_LT(left.after(step / 8.0, kStart + 10 * step), 0) << step;
  for (int step = 2; step <= 8; ++step)
    EXPECT_NEAR(left.after(step / 8.0, kStart + 10 * step), 10 * (8 - step), 1e-6) << step;
}

}  // namespace
}  // namespace cei3d
