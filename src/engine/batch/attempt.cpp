// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/attempt.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/parse_json.h"
#include "core/base/system.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

using Seconds = std::chrono::duration<double>;

fs::path numbered(const fs::path& item, const char* what, int n) {
  return item / fmt::format("{}-{:04}", what, n);
}

// The numbers N of what is called WHAT-N in a folder, in order.
std::vector<int> numbers_in(const fs::path& item, const std::string& what) {
  std::vector<int> out;
  std::error_code error;
  for (fs::directory_iterator it(item, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(what + "-") && name.find('.') == name.npos)
      out.push_back(std::atoi(name.c_str() + what.size() + 1));
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// The job of a scheduler that this process works for; it starts a job again only when it has ended.
struct Job {
  std::string name;
  int restart = 0;
};

Job present_job() {
  const std::string array = environment("SLURM_ARRAY_JOB_ID"), job = environment("SLURM_JOB_ID");
  if (job.empty()) return {};
  const std::string name = array.empty() ? job : array + "_" + environment("SLURM_ARRAY_TASK_ID");
  return {"slurm " + environment("SLURM_CLUSTER_NAME") + " " + name,
          std::atoi(environment("SLURM_RESTART_COUNT").c_str())};
}

std::string record() {
  const ProcessId me = this_process();
  const Job job = present_job();
  return Json{{"host", machine_name()}, {"space", me.space}, {"pid", me.pid},
              {"started", me.started},  {"job", job.name},   {"restart", job.restart}}
             .dump() +
         "\n";
}

// Whether the worker that wrote the file has ended; none: it cannot be told.
std::optional<bool> has_ended(const fs::path& attempt) {
  std::string bytes;
  try {
    bytes = read_file(attempt);
  } catch (const Error&) {
    return std::nullopt;  // it ends just now, or its file system is gone
  }
  const Json j = parse_json(bytes);
  if (!j.is_object()) return std::nullopt;  // it begins just now
  JsonReader r(j, attempt.string());
  const Job job = present_job(), its{r.require<std::string>("job"), r.require<int>("restart")};
  const ProcessId process{r.require<std::string>("space"), r.require<int>("pid"),
                          r.require<uint64_t>("started")};
  r.require<std::string>("host");  // for people
  r.finish();
  if (!job.name.empty() && its.name == job.name && its.restart < job.restart) return true;
  const auto runs = is_running(process);
  return runs ? std::optional(!*runs) : std::nullopt;
}

std::optional<fs::file_time_type> touched(const fs::path& file) {
  std::error_code error;
  const auto time = fs::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

bool is_fresh(const fs::path& attempt, const BatchTiming& timing) {
  const auto time = touched(attempt);
  return time && std::abs(Seconds(fs::file_time_type::clock::now() - *time).count()) < timing.stale;
}

// Watches a file that looks old: true when nobody touches it.
bool stays_untouched(const fs::path& attempt, const BatchTiming& timing) {
  constexpr double kBeats = 1.5;
  const auto before = touched(attempt);
  std::this_thread::sleep_for(Seconds(kBeats * timing.beat));
  return touched(attempt) == before;
}

bool is_over(const fs::path& attempt, const BatchTiming& timing) {
  if (has_ended(attempt).value_or(false)) return true;
  return !is_fresh(attempt, timing) && stays_untouched(attempt, timing);
}

int last_ended(const fs::path& item) {
  const auto state = read_batch_state(item);
  return state ? state->attempt : 0;
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

}  // namespace

fs::path batch_cancel_file(const fs::path& catalog) { return catalog / "cancelled"; }

bool batch_item_is_taken(const fs::path& item, const BatchTiming& timing) {
  const std::vector<int> numbers = numbers_in(item, "attempt");
  if (numbers.empty() || numbers.back() <= last_ended(item)) return false;
  const fs::path attempt = numbered(item, "attempt", numbers.back());
  return !has_ended(attempt).value_or(false) && is_fresh(attempt, timing);
}

std::unique_ptr<BatchAttempt> BatchAttempt::take(const fs::path& catalog, const std::string& id,
                                                 const BatchTiming& timing) {
  const fs::path item = batch_item_folder(catalog, id);
  std::error_code error;
  fs::create_directories(item, error);
  if (error) throw MachineError(fmt::format("Cannot make folder {}: {}.", item.string(), error.message()));
  const int ended = last_ended(item);
  const std::vector<int> numbers = numbers_in(item, "attempt");
  const int last = std::max(ended, numbers.empty() ? 0 : numbers.back());
  if (last > ended && !is_over(numbered(item, "attempt", last), timing)) return nullptr;
  const fs::path file = numbered(item, "attempt", last + 1);
  if (!write_new_file(file, record())) return nullptr;
  // Another worker may have made and ended an attempt of this number since the numbers were read.
  if (last_ended(item) > last) {
    remove_quietly(file);
    return nullptr;
  }
  std::unique_ptr<BatchAttempt> out(new BatchAttempt(catalog, item, last + 1));
  out->killed_ = int(std::count_if(numbers.begin(), numbers.end(), [&](int n) { return n > ended; }));
  out->adopt_work();
  out->heart_ = std::thread([a = out.get(), seconds = timing.beat] { a->beat(seconds); });
  return out;
}

BatchAttempt::BatchAttempt(fs::path catalog, fs::path item, int number)
    : catalog_(std::move(catalog)), item_(std::move(item)), number_(number) {}

BatchAttempt::~BatchAttempt() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  if (heart_.joinable()) heart_.join();
  if (!mine()) remove_quietly(work());  // a worker that has taken over has what was in it
  remove_quietly(numbered(item_, "attempt", number_));
}

fs::path BatchAttempt::work() const { return numbered(item_, "work", number_); }

bool BatchAttempt::mine() const {
  std::error_code error;
  return fs::exists(numbered(item_, "attempt", number_), error) &&
         !fs::exists(numbered(item_, "attempt", number_ + 1), error);
}

void BatchAttempt::require_mine() const {
  if (!mine())
    throw Error(
        ErrorCode::again,
        fmt::format("Another worker has taken over {}, because this one was not heard of for too long.",
                    item_.filename().string()));
}

// Takes over the work folder of the previous attempt, and removes the lock of the project in it, whose owner
// has ended.
void BatchAttempt::adopt_work() {
  const std::vector<int> folders = numbers_in(item_, "work");
  if (!folders.empty() && folders.back() < number_) {
    move_path(numbered(item_, "work", folders.back()), work());
    remove_quietly(work() / "project" / ".lock");
  }
  for (const int n : folders)
    if (n != number_) remove_quietly(numbered(item_, "work", n));
  fs::create_directories(work());
}

void BatchAttempt::beat(double seconds) {
  const auto stopped = [&] {
    std::unique_lock lock(mutex_);
    return stop_.wait_for(lock, Seconds(seconds), [&] { return stopping_; });
  };
  while (!stopped()) {
    std::error_code error;
    lost_ = lost_ || !mine() || !touch_file(numbered(item_, "attempt", number_));
    cancelled_ = cancelled_ || fs::exists(batch_cancel_file(catalog_), error);
  }
}

void BatchAttempt::publish(const fs::path& name) {
  require_mine();
  const fs::path to = item_ / name;
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (fs::exists(to, error)) move_path(to, work() / fmt::format("old-{}", set_aside_++));
  move_path(work() / name, to);
}

void BatchAttempt::publish_state(const BatchState& state) {
  write_file_atomic(work() / "state.json", state.json().dump() + "\n");
  require_mine();
  move_path(work() / "state.json", item_ / "state.json");
  for (const int n : numbers_in(item_, "attempt"))
    if (n < number_) remove_quietly(numbered(item_, "attempt", n));
}

}  // namespace cei3d
