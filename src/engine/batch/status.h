// SPDX-License-Identifier: Apache-2.0
// What has become of the objects of a catalog: made from their state files, which are the truth.
#pragma once

#include "engine/batch/manifest.h"

namespace cei3d {

struct BatchItemStatus {
  std::string id;
  std::optional<BatchState> state;
  bool running = false;  // a worker has it, as far as can be told
};

// States of all objects, in the order of the manifest, read on all threads of the caller.
std::vector<BatchItemStatus> batch_item_states(const BatchCatalog&, const BatchManifest&);

struct BatchStatus {
  size_t objects = 0, done = 0, failed = 0, running = 0, interrupted = 0, retryable = 0, waiting = 0;
  double per_hour = 0;     // objects done, over the time in which the last quarter of them was; 0: not known
  double hours_left = -1;  // negative: not known
  double core_hours = 0;   // time of all attempts that have ended, if each had one thread
  double slowest_seconds = 0, peak_memory_gib = 0;
  std::string slowest;
  std::vector<std::string> failures;  // "mug-17: reason"
  bool cancelled = false;
  Json json() const;
};
BatchStatus batch_status(const BatchCatalog&, const BatchManifest&);

// Lets objects that failed, and are not being worked on, be tried again; id: only this one. Returns how many.
// Error: there is no such object.
size_t batch_retry(const BatchCatalog&, const BatchManifest&, const std::string& id);

}  // namespace cei3d
