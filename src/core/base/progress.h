// SPDX-License-Identifier: Apache-2.0
// Progress reports, log lines and cancellation of long work.
#pragma once

#include <mutex>
#include <string>

namespace cei3d {

struct ProgressReport {
  std::string stage;         // "geometry", "light", "albedo", ...
  double fraction = 0;       // of the whole job, [0, 1]
  double seconds_left = -1;  // estimate; negative: unknown
  std::string message;       // "loss 0.0123, PSNR 31.2 dB"
};

// report(), log() and cancelled() may be called from any thread, and from several at once: calls of
// on_report() and on_log() come one at a time, so that an implementation needs no lock for what only those
// two use; is_cancelled() is called without a lock.
class Progress {
 public:
  Progress() = default;
  virtual ~Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void report(const ProgressReport& r) {
    const std::lock_guard lock(mutex_);
    on_report(r);
  }
  // One line of the run's JSON log.
  void log(const std::string& json_line) {
    const std::lock_guard lock(mutex_);
    on_log(json_line);
  }
  // True when the work shall stop: save and return early.
  bool cancelled() const { return is_cancelled(); }

 private:
  virtual void on_report(const ProgressReport&) {}
  virtual void on_log(const std::string&) {}
  virtual bool is_cancelled() const { return false; }

  std::mutex mutex_;
};

}  // namespace cei3d
