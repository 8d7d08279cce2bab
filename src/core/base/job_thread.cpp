// SPDX-License-Identifier: Apache-2.0
#include "core/base/job_thread.h"

#include <utility>

namespace cei3d {

class JobThread::JobProgress : public Progress {
 public:
  JobProgress(const JobThread& owner, std::string job) : owner_(owner), job_(std::move(job)) {}

 private:
  void on_report(const ProgressReport& r) override {
    if (owner_.listener_) owner_.listener_->on_progress(job_, r);
  }
  bool is_cancelled() const override { return owner_.cancelled_; }

  const JobThread& owner_;
  std::string job_;
};

JobThread::JobThread(JobListener* listener) : listener_(listener), thread_([this] { work(); }) {}

JobThread::~JobThread() { end(); }

void JobThread::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    cancelled_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void JobThread::add(const std::string& name, Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back({name, std::move(job)});
  }
  changed_.notify_all();
}

void JobThread::frame(const std::string& viewer, Step step) {
  {
    const std::lock_guard lock(mutex_);
    frames_[viewer] = {std::move(step), ++requests_};
  }
  changed_.notify_all();
}

void JobThread::drop_frame(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  frames_.erase(viewer);
}

void JobThread::drop_frames() {
  const std::lock_guard lock(mutex_);
  frames_.clear();
}

void JobThread::background(Step step) {
  {
    const std::lock_guard lock(mutex_);
    background_.push_back(std::make_shared<Step>(std::move(step)));
  }
  changed_.notify_all();
}

void JobThread::cancel(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (running_ == name) cancelled_ = true;
}

size_t JobThread::jobs_waiting() const {
  const std::lock_guard lock(mutex_);
  return jobs_.size() + (running_.empty() ? 0 : 1);
}

void JobThread::wait_until_idle() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [&] { return !busy_ && jobs_.empty() && frames_.empty() && background_.empty(); });
}

// A step of a frame of the next viewer, in the order of their names.
std::function<void()> JobThread::next_frame() {
  auto it = frames_.upper_bound(last_viewer_);
  if (it == frames_.end()) it = frames_.begin();
  last_viewer_ = it->first;
  return [this, viewer = it->first, frame = it->second] {
    if (frame.step()) return;
    const std::lock_guard lock(mutex_);
    const auto now = frames_.find(viewer);
    if (now != frames_.end() && now->second.number == frame.number) frames_.erase(now);
  };
}

std::function<void()> JobThread::next() {
  if (!jobs_.empty()) {
    NamedJob job = std::move(jobs_.front());
    jobs_.pop_front();
    running_ = job.name;
    cancelled_ = ending_;
    return [this, job = std::move(job)] { run_job(job); };
  }
  if (!frames_.empty()) return next_frame();
  if (background_.empty()) return nullptr;
  return [this, step = background_.front()] {
    if ((*step)()) return;
    const std::lock_guard lock(mutex_);
    background_.pop_front();
  };
}

void JobThread::run_job(const NamedJob& job) {
  JobProgress progress(*this, job.name);
  job.run(progress);
  const std::lock_guard lock(mutex_);
  running_.clear();
}

void JobThread::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    std::function<void()> job = ending_ ? nullptr : next();
    busy_ = bool(job);
    if (!job) {
      idle_.notify_all();
      if (ending_) return;
      changed_.wait(lock);
      continue;
    }
    lock.unlock();
    job();
    job = nullptr;  // destroys what it holds before the mutex is locked
    lock.lock();
  }
}

}  // namespace cei3d
