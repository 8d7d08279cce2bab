// SPDX-License-Identifier: Apache-2.0
// The time that a reconstruction was given, and its progress told by that.
#pragma once

#include "core/base/progress.h"

namespace cei3d {

// Passes reports on. With a time given, how far the run is and how long it still takes are a matter of the
// clock: stages that come twice, or take longer on one object than on another, never turn it back.
class RunClock : public Progress {
 public:
  // seconds: of the whole run, which begins now; 0: as long as it takes.
  RunClock(Progress& to, double seconds);
  void resume_at(double elapsed);  // a resumed run has used up this much already
  double elapsed() const;
  double left() const;  // below 0: late; infinite without a time given

 private:
  void on_report(const ProgressReport&) override;
  void on_log(const std::string& json_line) override { to_.log(json_line); }
  bool is_cancelled() const override { return to_.cancelled(); }

  Progress& to_;
  double seconds_, start_;
  double furthest_ = 0;  // fraction reported
};

}  // namespace cei3d
