// SPDX-License-Identifier: Apache-2.0
// One thread that works on behalf of several others, which never wait for it. Jobs run first, in their order,
// and all of them are run. Frames are computed step by step when no job waits; a new frame of a viewer
// replaces its previous one. Background work runs when there is nothing else to do.
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

// Gets the progress of the running job. Called from the job's thread and from threads that compute for it.
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
  // Cancels the running job, drops those that wait, and returns when the thread has ended.
  void end();

  // name: for the listener and cancel().
  void add(const std::string& name, Job);
  // Replaces the viewer's frame, even if its computation has begun.
  void frame(const std::string& viewer, Step);
  void drop_frame(const std::string& viewer);
  void drop_frames();  // of every viewer
  void background(Step);
  void cancel(const std::string& name);  // the running job, if it has that name, through its Progress

  size_t jobs_waiting() const;  // including the one that runs
  void wait_until_idle();       // for tests

 private:
  struct NamedJob {
    std::string name;
    Job run;
  };
  class JobProgress;
  void work();
  std::function<void()> next();  // what to run next; empty: nothing. Called with the mutex locked.
  std::function<void()> next_frame();
  void run_job(const NamedJob&);

  JobListener* listener_;
  mutable std::mutex mutex_;
  std::condition_variable changed_, idle_;
  std::deque<NamedJob> jobs_;
  struct Frame {
    Step step;
    uint64_t number;  // of the request, to tell a frame from a newer one of the same viewer
  };
  std::map<std::string, Frame> frames_;
  std::string last_viewer_;  // whose frame was computed last; viewers take turns
  std::deque<std::shared_ptr<Step>> background_;
  std::string running_;  // name of the job that runs; empty: none
  std::atomic<bool> cancelled_ = false;
  bool busy_ = false, ending_ = false;
  uint64_t requests_ = 0;
  std::thread thread_;
};

}  // namespace cei3d
