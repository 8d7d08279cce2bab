// SPDX-License-Identifier: Apache-2.0
#include "core/base/job_thread.h"

#include <gtest/gtest.h>

#include <future>

namespace cei3d {
namespace {

// Blocks the job thread until open() is called, so that everything that is added meanwhile waits.
class Gate {
 public:
  explicit Gate(JobThread& jobs) {
    jobs.add("gate", [this](Progress&) {
      entered_.set_value();
      open_.get_future().wait();
    });
    entered_.get_future().wait();
  }
  void open() { open_.set_value(); }

 private:
  std::promise<void> entered_, open_;
};

TEST(JobThread, JobsComeInOrderThenFramesThenTheRest) {
  std::string order;
  JobThread jobs(nullptr);
  Gate gate(jobs);
  jobs.background([&] { return order += "b", false; });
  jobs.frame("tab", [&] { return order += "f", false; });
  for (const char c : {'1', '2', '3'}) jobs.add("edit", [&order, c](Progress&) { order += c; });
  EXPECT_EQ(jobs.jobs_waiting(), 4u);
  gate.open();
  jobs.wait_until_idle();
  EXPECT_EQ(order, "123fb");
}

TEST(JobThread, OnlyTheNewestFrameOfAViewerIsComputedAndViewersTakeTurns) {
  std::string order;
  JobThread jobs(nullptr);
  Gate gate(jobs);
  const auto steps = [&](char c, int n) { return [&order, c, n]() mutable { return order += c, --n > 0; }; };
  jobs.frame("one", steps('x', 3));
  auto a = std::make_shared<int>(3), b = std::make_shared<int>(2);
  jobs.frame("one", [&order, a] { return order += 'a', --*a > 0; });
  jobs.frame("two", [&order, b] { return order += 'b', --*b > 0; });
  gate.open();
  jobs.wait_until_idle();
  EXPECT_EQ(order, "ababa");
}

TEST(JobThread, AJobWaitsForOneStepOfAFrameAndNoMore) {
  std::string order;
  JobThread jobs(nullptr);
  auto steps = std::make_shared<int>(0);
  jobs.frame("tab", [&, steps] {
    order += 'f';
    if (++*steps == 2) jobs.add("edit", [&](Progress&) { order += 'e'; });
    return *steps < 4;
  });
  jobs.wait_until_idle();
  EXPECT_EQ(order, "ffeff");
}

TEST(JobThread, ANewerFrameTakesThePlaceOfOneThatHasBegun) {
  std::string order;
  JobThread jobs(nullptr);
  jobs.frame("tab", [&] {
    order += 'o';
    jobs.frame("tab", [&] { return order += 'n', false; });
    return true;
  });
  jobs.wait_until_idle();
  EXPECT_EQ(order, "on");
}

TEST(JobThread, CancelsTheJobThatRunsAndNoOther) {
  JobThread jobs(nullptr);
  bool first = false, second = true;
  Gate gate(jobs);
  jobs.add("first", [&](Progress& p) {
    jobs.cancel("second");
    first = p.cancelled();
    jobs.cancel("first");
    first = !first && p.cancelled();
  });
  jobs.add("second", [&](Progress& p) { second = p.cancelled(); });
  gate.open();
  jobs.wait_until_idle();
  EXPECT_TRUE(first);
  EXPECT_FALSE(second);
}

class Reports : public JobListener {
 public:
  void on_progress(const std::string& job, const ProgressReport& r) override { text += job + r.stage; }
  std::string text;
};

TEST(JobThread, TellsTheListenerHowFarAJobIs) {
  Reports reports;
  JobThread jobs(&reports);
  jobs.add("paint", [](Progress& p) { p.report({" fit", 0.5, -1, ""}); });
  jobs.wait_until_idle();
  EXPECT_EQ(reports.text, "paint fit");
}

TEST(JobThread, EndsWithoutWhatStillWaits) {
  bool ran = false;
  {
    JobThread jobs(nullptr);
    jobs.add("long", [&](Progress& p) {
      jobs.add("later", [&](Progress&) { ran = true; });
      while (!p.cancelled()) std::this_thread::yield();
    });
    while (jobs.jobs_waiting() < 2) std::this_thread::yield();
  }
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace cei3d
