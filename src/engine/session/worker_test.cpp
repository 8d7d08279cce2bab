// SPDX-License-Identifier: Apache-2.0
// The order of jobs is tested in core/base/job_thread_test.cpp.
#include "engine/session/worker.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(Worker, HandsItsSessionToAllThatRuns) {
  auto session = std::make_unique<Session>("cpu", 1);
  const Session* const its = session.get();
  int got = 0;
  Worker worker(std::move(session), nullptr);
  worker.edit("edit", [&](Session& s, Progress&) { got += &s == its; });
  worker.frame("tab", [&](Session& s) { return got += &s == its, false; });
  worker.background([&](Session& s) { return got += &s == its, false; });
  worker.wait_until_idle();
  EXPECT_EQ(got, 3);
}

}  // namespace
}  // namespace cei3d
