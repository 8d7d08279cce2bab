// SPDX-License-Identifier: Apache-2.0
#include "core/base/rollback.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cei3d {
namespace {

TEST(Rollback, TakesBackWhatAnErrorInterrupts) {
  int begun = 0;
  EXPECT_THROW(
      {
        ++begun;
        const Rollback rollback([&] { --begun; });
        fail("The disk is full.");
      },
      Error);
  EXPECT_EQ(begun, 0);
}

TEST(Rollback, KeepsWhatWasFinished) {
  int begun = 0;
  {
    ++begun;
    Rollback rollback([&] { --begun; });
    rollback.keep();
  }
  EXPECT_EQ(begun, 1);
}

}  // namespace
}  // namespace cei3d
