// SPDX-License-Identifier: Apache-2.0
// What is known of one object of a catalog: items/<2 letters>/<id>/state.json. There is none before the first
// attempt has ended.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/json.h"

namespace cei3d {

// input: the capture or the options cannot be used; the same attempt would fail again.
// memory, machine, killed: another attempt may succeed.
enum class BatchCause { none, input, memory, machine, killed };
// waiting: no attempt has ended since `retry` asked for another. retryable: the last attempt failed by a
// cause that may pass.
enum class BatchOutcome { waiting, done, failed, retryable, interrupted };

const char* batch_outcome_name(BatchOutcome);
const char* batch_cause_name(BatchCause);

struct BatchState {
  BatchOutcome outcome = BatchOutcome::waiting;
  BatchCause cause = BatchCause::none;
  std::string key;     // hash of what the result depends on
  std::string reason;  // a sentence: why the object is not done
  int attempt = 0;     // number of the last attempt that has ended
  int tries = 0;       // attempts that failed or were killed since the key changed or `retry` was called
  int memory_doublings = 0;  // how often the memory for the next attempt is doubled
  double seconds = 0;        // time of all attempts that were not killed
  double peak_memory_gib = 0;
  int64_t ended = 0;  // seconds since 1970, by the clock of `host`
  std::string host;
  // What the steps found, for the index: {"psnr": ..., "warnings": [...], "files": {...}, ...}
  Json result = Json::object();

  Json json() const;
};

// The folder of an object in a catalog.
std::filesystem::path batch_item_folder(const std::filesystem::path& catalog, const std::string& id);

// None: no attempt has ended. Error: the file is damaged.
std::optional<BatchState> read_batch_state(const std::filesystem::path& item_folder);

}  // namespace cei3d
