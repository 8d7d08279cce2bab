// SPDX-License-Identifier: Apache-2.0
// The log file of a reconstruction.
#pragma once

#include <filesystem>
#include <fstream>

#include "core/base/progress.h"

namespace cei3d {

// Forwards progress and writes the log of the run: one JSON object per line.
class RunLog : public Progress {
 public:
  RunLog(Progress& listener, const std::filesystem::path& file)
      : listener_(listener), out_(file, std::ios::app) {}

 private:
  void on_report(const ProgressReport& r) override { listener_.report(r); }
  void on_log(const std::string& json_line) override {
    // Flushed, because it is read while the run goes on. Errors are ignored: a full disk must not stop
    // training.
    out_ << json_line << std::endl;
    listener_.log(json_line);
  }
  bool is_cancelled() const override { return listener_.cancelled(); }

  Progress& listener_;
  std::ofstream out_;
};

}  // namespace cei3d
