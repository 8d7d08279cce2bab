// SPDX-License-Identifier: Apache-2.0
// One thread that works on behalf of several others, which never wait for it. Jobs run in their order and are
// never dropped. Frames run step by step in between; of each viewer only the newest is wanted. What may wait
// runs last.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/progress.h"

namespace cei3d {

// Listens to the job that runs; called on the thread of the jobs and those that it computes on.
class JobListener {
 public:
  virtual ~JobListener() = default;
  virtual void on_progress(const std::string& job, const ProgressReport&) = 0;
};

class JobThread {
 public:
  using Job = std::function<void(Progress&)>;  // throws nothing
  using Step = std::function<bool()>;          // false: the work is done; throws nothing

  // listener: must outlive this; may be null.
  explicit JobThread(JobListener* listener);
  ~JobThread();  // end()
  // Cancels the running job, drops waiting ones and waits; nothing runs afterwards.
  void end();

  // name: for the listener and cancel().
  void add(const std::string& name, Job);
  // Replaces the viewer's frame, also one that has begun.
  void frame(const std::string& viewer, Step);
  void drop_frame(const std::string& viewer);
  void drop_frames();  // of every viewer
  void background(Step);
  void cancel(const std::string& name);  // the running job of that name: its Progress says so

  size_t jobs_waiting() const;  // including the one that runs
  void wait_until_idle();       // for tests

 private:
  struct NamedJob {
    std::string name;
    Job run;
  };
  class JobProgress;
  void work();
  std::function<void()> next();  // empty: nothing to do. With the mutex locked.
  std::function<void()> next_frame();
  void run_job(const NamedJob&);

  JobListener* listener_;
  mutable std::mutex mutex_;
  std::condition_variable changed_, idle_;
  std::deque<NamedJob> jobs_;
  struct Frame {
    Step step;
    uint64_t number;  // of the request; a newer one of the same viewer has another
  };
  std::map<std::string, Frame> frames_;
  std::string last_viewer_;  // viewers take turns
  std::deque<std::shared_ptr<Step>> background_;
  std::string running_;  // name of the job that runs; empty: none
  std::atomic<bool> cancelled_ = false;
  bool busy_ = false, ending_ = false;
  uint64_t requests_ = 0;
  std::thread thread_;
};

}  // namespace cei3d
