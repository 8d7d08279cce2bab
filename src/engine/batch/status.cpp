// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/status.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/parallel.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

bool has_ended(const std::optional<BatchState>& s) {
  return s && (s->outcome == BatchOutcome::done || s->outcome == BatchOutcome::failed);
}

void count(const BatchItemStatus& item, BatchStatus& out) {
  const BatchOutcome o = item.state ? item.state->outcome : BatchOutcome::waiting;
  size_t& n = item.running                     ? out.running
              : o == BatchOutcome::done        ? out.done
              : o == BatchOutcome::failed      ? out.failed
              : o == BatchOutcome::retryable   ? out.retryable
              : o == BatchOutcome::interrupted ? out.interrupted
                                               : out.waiting;
  ++n;
  if (!item.state) return;
  if (!item.running && !item.state->reason.empty())
    out.failures.push_back(fmt::format("{}: {}", item.id, item.state->reason));
  out.core_hours += item.state->seconds / 3600;
  out.peak_memory_gib = std::max(out.peak_memory_gib, item.state->peak_memory_gib);
  if (item.state->seconds <= out.slowest_seconds) return;
  out.slowest_seconds = item.state->seconds;
  out.slowest = item.id;
}

// Hosts' clocks differ by seconds, which matters little over a quarter of a catalog.
void estimate(std::vector<int64_t> ended, BatchStatus& out) {
  if (ended.size() < 2) return;
  std::sort(ended.begin(), ended.end());
  const size_t few = std::max<size_t>(2, ended.size() / 4);
  const int64_t seconds = ended.back() - ended[ended.size() - few];
  if (seconds <= 0) return;
  out.per_hour = double(few - 1) * 3600 / double(seconds);
  out.hours_left = double(out.objects - out.done - out.failed) / out.per_hour;
}

}  // namespace

std::vector<BatchItemStatus> batch_item_states(const BatchCatalog& catalog, const BatchManifest& manifest) {
  constexpr int kPiece = 256;
  std::vector<BatchItemStatus> out(manifest.size());
  parallel_ranges(int(manifest.size()), kPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      BatchItemStatus& s = out[size_t(i)];
      s.id = manifest.id(size_t(i));
      const fs::path folder = batch_item_folder(catalog.folder(), s.id);
      s.state = read_batch_state(folder);
      s.running = !has_ended(s.state) && batch_item_is_taken(folder, catalog.settings().timing);
    }
  });
  return out;
}

BatchStatus batch_status(const BatchCatalog& catalog, const BatchManifest& manifest) {
  BatchStatus out;
  std::error_code error;
  out.cancelled = fs::exists(batch_cancel_file(catalog.folder()), error);
  out.objects = manifest.size();
  std::vector<int64_t> ended;
  for (const BatchItemStatus& item : batch_item_states(catalog, manifest)) {
    count(item, out);
    if (item.state && item.state->outcome == BatchOutcome::done) ended.push_back(item.state->ended);
  }
  estimate(std::move(ended), out);
  return out;
}

Json BatchStatus::json() const {
  return {{"objects", objects},
          {"done", done},
          {"failed", failed},
          {"running", running},
          {"interrupted", interrupted},
          {"again", retryable},
          {"waiting", waiting},
          {"per_hour", per_hour},
          {"hours_left", hours_left},
          {"core_hours", core_hours},
          {"slowest", {{"id", slowest}, {"seconds", slowest_seconds}}},
          {"peak_memory_gib", peak_memory_gib},
          {"failures", failures},
          {"cancelled", cancelled}};
}

size_t batch_retry(const BatchCatalog& catalog, const BatchManifest& manifest, const std::string& id) {
  size_t changed = 0, found = 0;
  for (const BatchItemStatus& item : batch_item_states(catalog, manifest)) {
    if (!id.empty() && item.id != id) continue;
    ++found;
    if (item.running || !item.state || item.state->outcome != BatchOutcome::failed) continue;
    const auto attempt = BatchAttempt::take(catalog.folder(), item.id, catalog.settings().timing);
    if (!attempt) continue;
    BatchState state = *item.state;
    state.outcome = BatchOutcome::waiting;
    state.cause = BatchCause::none;
    state.reason = "";
    state.attempt = attempt->number();
    state.tries = 0;
    attempt->publish_state(state);
    ++changed;
  }
  if (found == 0) fail("There is no object '{}' in this catalog.", id);
  return changed;
}

}  // namespace cei3d
