// SPDX-License-Identifier: Apache-2.0
// The clock of a reconstruction, and the progress of its stages as fractions of the whole run.
#pragma once

#include <string>

#include "core/base/clock.h"
#include "core/base/progress.h"

namespace cei3d {

// Stages report their own fraction; passed on is the fraction of the whole run, which never decreases. With a
// time limit it is the elapsed share of the time.
class RunClock : public Progress {
 public:
  // seconds: of the whole run, which begins now; 0: no limit.
  RunClock(Progress& to, Clock clock, double seconds);

  double now() const { return clock_(); }
  const Clock& clock() const { return clock_; }
  void resume_at(double elapsed);  // an earlier part of the run took this many seconds
  double elapsed() const { return now() - start_; }
  double left() const;  // below 0: late; infinite without a limit

  // Later reports are of this stage, which is the part [begin, end) of the run.
  void enter(std::string stage, double begin, double end);

 private:
  // r.fraction: of the stage. r.stage: what the stage is doing, passed on in the message.
  void on_report(const ProgressReport& r) override;
  void on_log(const std::string& json_line) override { to_.log(json_line); }
  bool is_cancelled() const override { return to_.cancelled(); }

  Progress& to_;
  Clock clock_;
  double seconds_, start_;
  std::string stage_;
  double begin_ = 0, end_ = 0;
  double max_fraction_ = 0;  // reported so far
};

}  // namespace cei3d
