// SPDX-License-Identifier: Apache-2.0
// The one thread that uses a Session on behalf of several others: a JobThread whose jobs get the session.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "core/base/job_thread.h"
#include "engine/session/session.h"

namespace cei3d {

class Worker {
 public:
  using Job = std::function<void(Session&, Progress&)>;  // throws nothing
  using Step = std::function<bool(Session&)>;            // false: the work is done; throws nothing

  // listener: must outlive this; may be null.
  Worker(std::unique_ptr<Session> session, JobListener* listener)
      : session_(std::move(session)), thread_(listener) {}
  // Cancels the running job and waits for it; nothing runs afterwards.
  void end() { thread_.end(); }

  void edit(const std::string& name, Job job) {
    thread_.add(name, [s = session_.get(), job = std::move(job)](Progress& p) { job(*s, p); });
  }
  void frame(const std::string& viewer, Step step) { thread_.frame(viewer, with_session(std::move(step))); }
  void drop_frame(const std::string& viewer) { thread_.drop_frame(viewer); }
  void drop_frames() { thread_.drop_frames(); }
  void background(Step step) { thread_.background(with_session(std::move(step))); }
  void cancel(const std::string& name) { thread_.cancel(name); }

  size_t edits_waiting() const { return thread_.jobs_waiting(); }
  void wait_until_idle() { thread_.wait_until_idle(); }  // for tests

 private:
  JobThread::Step with_session(Step step) const {
    return [s = session_.get(), step = std::move(step)] { return step(*s); };
  }

  std::unique_ptr<Session> session_;
  JobThread thread_;  // last: it uses the session
};

}  // namespace cei3d
