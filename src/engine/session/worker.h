// SPDX-License-Identifier: Apache-2.0
// The one thread that uses a Session on behalf of several others, which never wait for each other's work.
// Edits run in their order and are never dropped. Frames run step by step in between; of each viewer only the
// newest is wanted. What may wait runs last.
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
#include "engine/session/session.h"

namespace cei3d {

// Listens to the job that runs; called on the worker's thread and those that it computes on.
class JobListener {
 public:
  virtual ~JobListener() = default;
  virtual void on_progress(const std::string& job, const ProgressReport&) = 0;
};

class Worker {
 public:
  using Job = std::function<void(Session&, Progress&)>;  // throws nothing
  using Step = std::function<bool(Session&)>;            // false: the work is done; throws nothing

  // listener: must outlive this; may be null.
  Worker(std::unique_ptr<Session>, JobListener* listener);
  ~Worker();  // end()
  // Cancels the running job and waits for it; nothing runs afterwards.
  void end();

  // name: for the listener and cancel().
  void edit(const std::string& name, Job);
  // Replaces the viewer's frame, also one that has begun.
  void frame(const std::string& viewer, Step);
  void drop_frame(const std::string& viewer);
  void drop_frames();  // of every viewer
  void background(Step);
  void cancel(const std::string& name);  // the running job of that name: its Progress says so

  size_t edits_waiting() const;  // including the one that runs
  void wait_until_idle();        // for tests

 private:
  struct NamedJob {
    std::string name;
    Job run;
  };
  class JobProgress;
  void work();
  std::function<void()> next();  // empty: nothing to do. With the mutex locked.
  std::function<void()> next_frame();
  void run_edit(const NamedJob&);

  std::unique_ptr<Session> session_;
  JobListener* listener_;
  mutable std::mutex mutex_;
  std::condition_variable changed_, idle_;
  std::deque<NamedJob> edits_;
  struct Frame {
    Step step;
    uint64_t number;  // of the request; a newer one of the same viewer has another
  };
  std::map<std::string, Frame> frames_;
  std::string last_viewer_;  // viewers take turns
  std::deque<std::shared_ptr<Step>> background_;
  std::string running_;  // name of the edit that runs; empty: none
  std::atomic<bool> cancelled_ = false;
  bool busy_ = false, ending_ = false;
  uint64_t requests_ = 0;
  std::thread thread_;
};

}  // namespace cei3d
