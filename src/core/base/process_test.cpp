// SPDX-License-Identifier: Apache-2.0
#include "core/base/process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

int wait_for(Child& child) {
  while (!child.exit_code()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return *child.exit_code();
}

TEST(Process, ItselfRunsAndOneThatNeverWasDoesNot) {
  ProcessId me = this_process();
  EXPECT_EQ(is_running(me), true);
  me.started += 1;  // another process that had the same number
  EXPECT_EQ(is_running(me), false);
  me.space = "another machine";
  EXPECT_EQ(is_running(me), std::nullopt);
}

TEST(Process, AChildAppendsItsOutputAndTellsItsCode) {
  const TempFolder folder;
  const auto file = folder.path() / "log";
  write_file_atomic(file, "before\n");
  Child child({"sh", "-c", "echo out; echo err >&2; exit 7"}, file);
  EXPECT_EQ(wait_for(child), 7);
  EXPECT_EQ(read_file(file), "before\nout\nerr\n");
}

TEST(Process, AChildThatIsAskedToStopEndsByTheSignal) {
  const TempFolder folder;
  Child child({"sleep", "100"}, folder.path() / "log");
  child.ask_to_stop();
  EXPECT_EQ(wait_for(child), 128 + 15);
}

TEST(Process, RunsAProgramOrSaysThatThereIsNone) {
  const ProgramOutput out = run_program({"sh", "-c", "echo 12; exit 3"});
  EXPECT_EQ(out.text, "12\n");
  EXPECT_EQ(out.exit_code, 3);
  EXPECT_NE(message([] { run_program({"no-such-program"}); }).find("no-such-program"), std::string::npos);
}

}  // namespace
}  // namespace cei3d
