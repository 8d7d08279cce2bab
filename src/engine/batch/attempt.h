// SPDX-License-Identifier: Apache-2.0
// The right to work on an object of a catalog: of all workers on all machines one has it.
//
// Attempts are numbered. To begin attempt N is to create the file attempt-N, which file systems let only one
// process do. A worker touches its file every few seconds. Another one may begin attempt N+1 when the worker
// is known to have ended, or when its file was not touched for long; it renames the folder work-N, in which
// all results are made, to work-N+1. A worker that was only slow finds its folder gone: results become
// visible by a rename out of that folder, so that it can publish nothing.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "core/base/process.h"
#include "engine/batch/state.h"

namespace cei3d {

struct BatchTiming {
  double beat = 10;   // seconds between two touches
  double stale = 60;  // seconds without a touch after which a worker is suspected to be gone, then watched
};

class BatchAttempt {
 public:
  // None: another worker has the object. Takes 1.5 beats when a worker is suspected to be gone: its file is
  // watched, so that clocks that jump or differ do no harm.
  static std::unique_ptr<BatchAttempt> take(const std::filesystem::path& catalog, const std::string& id,
                                            const BatchTiming&);
  // Gives the object back.
  ~BatchAttempt();
  BatchAttempt(const BatchAttempt&) = delete;
  BatchAttempt& operator=(const BatchAttempt&) = delete;

  int number() const { return number_; }
  // Number of earlier attempts that ended without writing state.json, since the last one that wrote it.
  int killed_before() const { return killed_; }
  std::filesystem::path item() const { return item_; }
  std::filesystem::path work() const;  // the folder to make results in

  bool lost() const { return lost_; }            // another worker has taken over
  bool cancelled() const { return cancelled_; }  // the whole catalog was cancelled
  // Moves work()/name to item()/name. What is there already is moved into work() first. Error
  // (ErrorCode::again): another worker has taken over; nothing has changed.
  void publish(const std::filesystem::path& name);
  void publish_state(const BatchState&);

 private:
  BatchAttempt(std::filesystem::path catalog, std::filesystem::path item, int number);
  bool mine() const;
  void require_mine() const;
  void adopt_work();
  void beat(double seconds);

  std::filesystem::path catalog_, item_;
  int number_, killed_ = 0, set_aside_ = 0;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::atomic<bool> lost_ = false, cancelled_ = false;
  std::thread heart_;
};

// Whether a worker has the object now, as far as can be told without waiting.
bool batch_item_is_taken(const std::filesystem::path& item_folder, const BatchTiming&);

// The file that asks all workers of a catalog to save and stop.
std::filesystem::path batch_cancel_file(const std::filesystem::path& catalog);

}  // namespace cei3d
