// SPDX-License-Identifier: Apache-2.0
// How long work talks to whoever asked for it.
#pragma once

#include <string>

namespace cei3d {

struct ProgressReport {
  std::string stage;         // "geometry", "light", "albedo", ...
  double fraction = 0;       // of the whole job, [0, 1]
  double seconds_left = -1;  // estimate; negative: unknown
  std::string message;       // "loss 0.0123, PSNR 31.2 dB"
};

class Progress {
 public:
  virtual ~Progress() = default;
  virtual void report(const ProgressReport&) {}
  virtual void log(const std::string& json_line) { (void)json_line; }  // one line of the run's JSON log
  virtual bool cancelled() const { return false; }                     // asked to stop: save and return early
};

}  // namespace cei3d
