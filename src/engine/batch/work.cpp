// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/work.h"

#include <algorithm>
#include <new>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/system.h"
#include "engine/batch/item_work.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// In the order of BatchResult. Scripts read these words.
constexpr const char* kResults[] = {"done", "already", "failed", "again", "taken", "interrupted"};

// How an attempt ended.
struct Ending {
  BatchOutcome outcome;
  BatchCause cause;
  std::string reason;
};

// The disk is full or a file system is gone, although the error does not tell.
bool machine_is_in_the_way(const BatchCatalog& catalog, const BatchItem& item) {
  constexpr uintmax_t kMinSpace = 1 << 20;
  std::error_code error;
  const fs::space_info space = fs::space(catalog.folder(), error);
  if (error || space.available < kMinSpace) return true;
  if (catalog.prepared() && !fs::exists(catalog.folder() / "batch.json", error)) return true;
  return item.planned && !fs::exists(item.capture, error);
}

std::string sentences(const Error& e) {
  return e.hint().empty() ? e.what() : fmt::format("{} {}", e.what(), e.hint());
}

Ending ending_of(const std::exception_ptr& thrown, const BatchCatalog& catalog, const BatchItem& item) {
  const auto of_text = [&](const std::string& text) {
    return machine_is_in_the_way(catalog, item) ? Ending{BatchOutcome::retryable, BatchCause::machine, text}
                                                : Ending{BatchOutcome::failed, BatchCause::input, text};
  };
  try {
    std::rethrow_exception(thrown);
  } catch (const MachineError& e) {
    return {BatchOutcome::retryable, BatchCause::machine, e.what()};
  } catch (const Error& e) {
    if (e.code() == ErrorCode::interrupted) return {BatchOutcome::interrupted, BatchCause::none, e.what()};
    if (e.code() == ErrorCode::again) return {BatchOutcome::retryable, BatchCause::none, e.what()};
    return of_text(sentences(e));
  } catch (const std::bad_alloc&) {
    return {BatchOutcome::retryable, BatchCause::memory, "There was not enough memory."};
  } catch (const std::exception& e) {
    return of_text(e.what());
  }
}

// One attempt: makes the object and writes state.json, also where it fails.
class Try {
 public:
  Try(const BatchCatalog& catalog, const BatchItem& item, const BatchSteps& steps, BatchAttempt& attempt)
      : catalog_(catalog), item_(item), steps_(steps), attempt_(attempt) {
    if (auto before = read_batch_state(attempt.item())) state_ = *before;
    if (state_.key != steps.key) state_.tries = state_.memory_doublings = 0;
    state_.key = steps.key;
    state_.attempt = attempt.number();
    state_.tries += attempt.killed_before();
    state_.host = machine_name();
  }

  BatchWorkReport run(Session& session, Progress& progress) {
    const double start = steady_seconds();
    try {
      require_tries_left();
      ItemProgress watched(progress, attempt_);
      state_.result = make_item(steps_, attempt_, session, watched);
      end({BatchOutcome::done, BatchCause::none, ""}, steady_seconds() - start);
    } catch (...) {
      end(ending_of(std::current_exception(), catalog_, item_), steady_seconds() - start);
    }
    return {item_.id, result(), state_.reason, steady_seconds() - start};
  }

 private:
  void require_tries_left() {
    if (attempt_.killed_before() > 0 && state_.tries > catalog_.settings().retries)
      throw Error(
          ErrorCode::failed,
          fmt::format(
              "Its worker was killed {} times without an error message: probably the memory is too small, or "
              "a machine is failing.",
              state_.tries),
          "`cei3d batch retry` tries again.");
  }

  Ending lost() const {
    if (machine_is_in_the_way(catalog_, item_))
      return {BatchOutcome::retryable, BatchCause::machine,
              "The catalog is out of reach: its file system is gone, or its disk is full."};
    return {BatchOutcome::retryable, BatchCause::none, "Another worker has taken over."};
  }

  void end(Ending f, double seconds) {
    if (attempt_.lost()) f = lost();
    if (f.cause == BatchCause::memory && ++state_.memory_doublings > 1) f.outcome = BatchOutcome::failed;
    state_.outcome = f.outcome;
    state_.cause = f.cause;
    state_.reason = f.reason;
    state_.tries =
        f.outcome == BatchOutcome::done ? 0 : state_.tries + (f.outcome == BatchOutcome::retryable);
    state_.seconds += seconds;
    state_.peak_memory_gib = std::max(state_.peak_memory_gib, peak_memory_gib());
    state_.ended =
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
            .count();
    try {
      attempt_.publish_state(state_);
    } catch (const Error& e) {  // a full disk, or another worker has taken over: only the caller can be told
      if (state_.outcome != BatchOutcome::interrupted) state_.outcome = BatchOutcome::retryable;
      if (state_.reason.empty()) state_.reason = e.what();
      return;
    }
    std::error_code ignored;
    if (f.outcome == BatchOutcome::done || f.outcome == BatchOutcome::failed)
      fs::remove_all(attempt_.work(), ignored);
  }

  BatchResult result() const {
    return state_.outcome == BatchOutcome::done          ? BatchResult::done
           : state_.outcome == BatchOutcome::failed      ? BatchResult::failed
           : state_.outcome == BatchOutcome::interrupted ? BatchResult::interrupted
                                                         : BatchResult::retryable;
  }

  const BatchCatalog& catalog_;
  const BatchItem& item_;
  const BatchSteps& steps_;
  BatchAttempt& attempt_;
  BatchState state_;
};

BatchWorkReport settled_report(const std::string& id, const BatchState& state) {
  if (state.outcome == BatchOutcome::done) return {id, BatchResult::up_to_date, "", 0};
  return {id, BatchResult::failed, state.reason, 0};
}

// Workers begin at different objects, so that they seldom want the same one.
size_t first_of(const BatchManifest& manifest) {
  const std::string hash = content_hash(fmt::format("{} {}", machine_name(), this_process().pid));
  return std::stoul(hash.substr(0, 8), nullptr, 16) % manifest.size();
}

BatchWorkReport unguarded_work(const BatchCatalog& catalog, const BatchManifest& manifest, size_t index,
                               Session& session, Progress& progress) {
  const std::string& id = manifest.id(index);
  const fs::path folder = batch_item_folder(catalog.folder(), id);
  std::error_code error;
  if (fs::exists(batch_cancel_file(catalog.folder()), error))
    return {id, BatchResult::interrupted, "The catalog was cancelled; `cei3d batch run` goes on with it.", 0};
  const BatchItem item = catalog.item(manifest, index);
  const std::string files = item.capture.empty() ? "" : capture_files_hash(item.capture);
  const bool gone = files.empty() && !item.capture.empty();
  const BatchSteps steps = batch_steps(item, files, session);
  const auto settled = [&]() -> std::optional<BatchWorkReport> {
    const auto state = read_batch_state(folder);
    if (!batch_is_settled(state, steps.key, gone)) return std::nullopt;
    return settled_report(id, *state);
  };
  if (auto report = settled()) return *report;
  const auto attempt = BatchAttempt::take(catalog.folder(), id, catalog.settings().timing);
  if (!attempt) return {id, BatchResult::in_use, "Another worker has it.", 0};
  if (auto report = settled()) return *report;  // another worker has made it since the first look
  return Try(catalog, item, steps, *attempt).run(session, progress);
}

}  // namespace

const char* batch_result_name(BatchResult r) { return kResults[size_t(r)]; }

Json BatchWorkReport::json() const {
  Json j{{"id", id}, {"result", batch_result_name(result)}, {"seconds", seconds}};
  if (!reason.empty()) j["sentence"] = reason;
  return j;
}

bool batch_is_settled(const std::optional<BatchState>& state, const std::string& key, bool gone) {
  if (!state) return false;
  const bool ended = state->outcome == BatchOutcome::done || state->outcome == BatchOutcome::failed;
  return (ended && state->key == key) || (state->outcome == BatchOutcome::done && gone);
}

BatchWorkReport batch_work(const BatchCatalog& catalog, const BatchManifest& manifest, size_t index,
                           Session& session, Progress& progress) {
  try {
    return unguarded_work(catalog, manifest, index, session, progress);
  } catch (const MachineError& e) {
    return {manifest.id(index), BatchResult::retryable, e.what(), 0};
  }
}

std::vector<BatchWorkReport> batch_claim(const BatchCatalog& catalog, const BatchManifest& manifest,
                                         Session& session, Progress& progress) {
  std::vector<BatchWorkReport> out;
  const size_t first = first_of(manifest);
  for (size_t i = 0; i < manifest.size(); ++i) {
    const BatchWorkReport r = batch_work(catalog, manifest, (first + i) % manifest.size(), session, progress);
    if (r.result == BatchResult::in_use || r.result == BatchResult::up_to_date) continue;
    out.push_back(r);
    progress.report({"catalog", double(i + 1) / double(manifest.size()), -1, r.id});
    if (r.result == BatchResult::interrupted) break;
  }
  return out;
}

}  // namespace cei3d
