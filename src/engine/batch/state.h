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
// waiting: `retry` asks for another attempt. again: an attempt failed by a cause that may pass.
enum class BatchOutcome { waiting, done, failed, again, interrupted };

const char* batch_outcome_name(BatchOutcome);
const char* batch_cause_name(BatchCause);

struct BatchState {
  BatchOutcome outcome = BatchOutcome::waiting;
  BatchCause cause = BatchCause::none;
  std::string key;           // of the work that it tells of
  std::string sentence;      // why it failed
  int attempt = 0;           // the last one that has ended
  int tries = 0;             // attempts that failed or were killed since the key was new or `retry`
  int memory_doublings = 0;  // to ask for at the next attempt
  double seconds = 0;        // of all attempts that ended by themselves
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
