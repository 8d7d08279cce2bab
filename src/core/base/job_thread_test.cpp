// SPDX-License-Identifier: Apache-2.0
#include "engine/session/worker.h"

#include <gtest/gtest.h>

#include <future>

namespace cei3d {
namespace {

std::unique_ptr<Session> a_session() { return std::make_unique<Session>("cpu", 1); }

// Holds the worker until it is let go, so that what is asked for meanwhile waits.
class Gate {
 public:
  explicit Gate(Worker& worker) {
    worker.edit("gate", [this](Session&, Progress&) {
      entered_.set_value();
      open_.get_future().wait();
    });
    entered_.get_future().wait();
  }
  void open() { open_.set_value(); }

 private:
  std::promise<void> entered_, open_;
};

TEST(Worker, EditsComeInOrderThenFramesThenTheRest) {
  std::string order;
  Worker worker(a_session(), nullptr);
  Gate gate(worker);
  worker.background([&](Session&) { return order += "b", false; });
  worker.frame("tab", [&](Session&) { return order += "f", false; });
  for (const char c : {'1', '2', '3'}) worker.edit("edit", [&order, c](Session&, Progress&) { order += c; });
  EXPECT_EQ(worker.edits_waiting(), 4u);
  gate.open();
  worker.wait_until_idle();
  EXPECT_EQ(order, "123fb");
}

TEST(Worker, OnlyTheNewestFrameOfAViewerIsComputedAndViewersTakeTurns) {
  std::string order;
  Worker worker(a_session(), nullptr);
  Gate gate(worker);
  const auto steps = [&](char c, int n) {
    return [&order, c, n](Session&) mutable { return order += c, --n > 0; };
  };
  worker.frame("one", steps('x', 3));
  auto a = std::make_shared<int>(3), b = std::make_shared<int>(2);
  worker.frame("one", [&order, a](Session&) { return order += 'a', --*a > 0; });
  worker.frame("two", [&order, b](Session&) { return order += 'b', --*b > 0; });
  gate.open();
  worker.wait_until_idle();
  EXPECT_EQ(order, "ababa");
}

TEST(Worker, AnEditWaitsForOneStepOfAFrameAndNoMore) {
  std::string order;
  Worker worker(a_session(), nullptr);
  auto steps = std::make_shared<int>(0);
  worker.frame("tab", [&, steps](Session&) {
    order += 'f';
    if (++*steps == 2) worker.edit("edit", [&](Session&, Progress&) { order += 'e'; });
    return *steps < 4;
  });
  worker.wait_until_idle();
  EXPECT_EQ(order, "ffeff");
}

TEST(Worker, ANewerFrameTakesThePlaceOfOneThatHasBegun) {
  std::string order;
  Worker worker(a_session(), nullptr);
  worker.frame("tab", [&](Session&) {
    order += 'o';
    worker.frame("tab", [&](Session&) { return order += 'n', false; });
    return true;
  });
  worker.wait_until_idle();
  EXPECT_EQ(order, "on");
}

TEST(Worker, CancelsTheJobThatRunsAndNoOther) {
  Worker worker(a_session(), nullptr);
  bool first = false, second = true;
  Gate gate(worker);
  worker.edit("first", [&](Session&, Progress& p) {
    worker.cancel("second");
    first = p.cancelled();
    worker.cancel("first");
    first = !first && p.cancelled();
  });
  worker.edit("second", [&](Session&, Progress& p) { second = p.cancelled(); });
  gate.open();
  worker.wait_until_idle();
  EXPECT_TRUE(first);
  EXPECT_FALSE(second);
}

class Reports : public JobListener {
 public:
  void on_progress(const std::string& job, const ProgressReport& r) override { text += job + r.stage; }
  std::string text;
};

TEST(Worker, TellsTheListenerHowFarAJobIs) {
  Reports reports;
  Worker worker(a_session(), &reports);
  worker.edit("paint", [](Session&, Progress& p) { p.report({" fit", 0.5, -1, ""}); });
  worker.wait_until_idle();
  EXPECT_EQ(reports.text, "paint fit");
}

TEST(Worker, EndsWithoutWhatStillWaits) {
  bool ran = false;
  {
    Worker worker(a_session(), nullptr);
    worker.edit("long", [&](Session&, Progress& p) {
      worker.edit("later", [&](Session&, Progress&) { ran = true; });
      while (!p.cancelled()) std::this_thread::yield();
    });
    while (worker.edits_waiting() < 2) std::this_thread::yield();
  }
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace cei3d
