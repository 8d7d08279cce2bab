// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/local_engine.h"

#include <algorithm>
#include <deque>
#include <thread>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/process.h"
#include "core/base/system.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

struct Waiting {
  size_t index = 0;
  int failures = 0;  // in this run, by causes that may pass
  double not_before = 0;
  double memory_gib = 0;
};

struct Running {
  Waiting what;
  Child child;
};

class LocalEngine {
 public:
  LocalEngine(const BatchCatalog& catalog, const LocalRun& run, Progress& progress)
      : catalog_(catalog), run_(run), progress_(progress), manifest_(BatchManifest::read(run.manifest)) {
    fs::create_directories(catalog.folder() / "logs");
    log_ = catalog.folder() / "logs" /
           fmt::format("{}-{}-{}.log", utc_text("%Y%m%dT%H%M%S"), machine_name(), this_process().pid);
    for (size_t i = 0; i < manifest_.size(); ++i) queue_.push_back({i, 0, 0, run.memory_gib});
  }

  BatchRunReport run() {
    const double start = steady_seconds();
    while (!queue_.empty() || !running_.empty()) {
      if (progress_.cancelled()) stop();
      start_some();
      collect();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    report_.objects = manifest_.size();
    report_.seconds = steady_seconds() - start;
    return report_;
  }

 private:
  double memory_in_use() const {
    double sum = 0;
    for (const Running& r : running_) sum += r.what.memory_gib;
    return sum;
  }

  bool has_room_for(const Waiting& w) const {
    if (running_.empty()) return true;
    return int(running_.size()) < run_.jobs && memory_in_use() + w.memory_gib <= memory_gib();
  }

  void start_some() {
    for (size_t looked = queue_.size(); looked > 0 && int(running_.size()) < run_.jobs; --looked) {
      const Waiting next = queue_.front();
      queue_.pop_front();
      if (next.not_before > steady_seconds() || !has_room_for(next))
        queue_.push_back(next);
      else
        start(next);
    }
  }

  // An object that another launcher works on is looked at again, without a process for it.
  void start(Waiting next) {
    constexpr double kLookAgain = 1;
    const fs::path folder = batch_item_folder(catalog_.folder(), manifest_.id(next.index));
    if (batch_item_is_taken(folder, catalog_.settings().timing)) {
      next.not_before = steady_seconds() + kLookAgain;
      queue_.push_back(next);
      return;
    }
    running_.push_back({next, Child({run_.program.string(), "batch", "work", run_.manifest.string(), "-o",
                                     catalog_.folder().string(), "--index", std::to_string(next.index),
                                     "--threads", std::to_string(run_.threads), "--quiet"},
                                    log_)});
  }

  void collect() {
    for (size_t i = 0; i < running_.size();) {
      const auto code = running_[i].child.exit_code();
      if (!code) {
        ++i;
        continue;
      }
      const Waiting what = running_[i].what;
      running_.erase(running_.begin() + long(i));
      ended(what, *code);
    }
  }

  void ended(Waiting w, int code) {
    constexpr double kLongestPause = 60;
    if (code == 0) {
      ++report_.done;
    } else if (code == int(ErrorCode::failed) || code == int(ErrorCode::usage) ||
               ++w.failures > catalog_.settings().retries) {
      report_.not_done.push_back(fmt::format("{}: {}", manifest_.id(w.index), why(w.index, code)));
    } else {
      constexpr int kKilled = 128 + 9;  // as the system does when memory runs out
      if (code == kKilled) w.memory_gib *= 2;
      w.not_before = steady_seconds() + std::min(kLongestPause, 0.1 * double(1 << std::min(w.failures, 10)));
      queue_.push_back(w);
      return;
    }
    const size_t ended = report_.done + report_.not_done.size();
    progress_.report({"catalog", double(ended) / double(manifest_.size()), -1,
                      fmt::format("{} of {}, {} failed", ended, manifest_.size(), report_.not_done.size())});
  }

  std::string why(size_t index, int code) const {
    const auto state = read_batch_state(batch_item_folder(catalog_.folder(), manifest_.id(index)));
    if (state && !state->reason.empty()) return state->reason;
    return fmt::format("Its worker ended with exit code {}; see {}.", code, log_.string());
  }

  // Workers save their state first.
  [[noreturn]] void stop() {
    for (Running& r : running_) r.child.ask_to_stop();
    running_.clear();  // waits for them
    throw Error(ErrorCode::interrupted,
                fmt::format("Interrupted after {} of {} objects; the same command goes on.", report_.done,
                            manifest_.size()));
  }

  const BatchCatalog& catalog_;
  const LocalRun& run_;
  Progress& progress_;
  BatchManifest manifest_;
  fs::path log_;
  std::deque<Waiting> queue_;
  std::vector<Running> running_;
  BatchRunReport report_;
};

}  // namespace

Json BatchRunReport::json() const {
  return {{"objects", objects}, {"done", done}, {"not_done", not_done}, {"seconds", seconds}};
}

BatchRunReport run_locally(const BatchCatalog& catalog, const LocalRun& run, Progress& progress) {
  return LocalEngine(catalog, run, progress).run();
}

}  // namespace cei3d
