// SPDX-License-Identifier: Apache-2.0
// Runs a catalog on this machine: a process for each object, so that one that dies takes no other with it.
#pragma once

#include "engine/batch/manifest.h"

namespace cei3d {

struct LocalRun {
  std::filesystem::path program;  // cei3d
  std::filesystem::path manifest;
  int jobs = 1;     // maximum number of objects at a time
  int threads = 1;  // threads per object
  // Expected memory per object, GiB; an object that ran out of memory gets twice as much.
  double memory_gib = 2;
};

struct BatchRunReport {
  size_t objects = 0, done = 0;
  std::vector<std::string> not_done;  // "mug-17: reason"
  double seconds = 0;
  Json json() const;
};

// Error: interrupted, when all workers have saved.
BatchRunReport run_locally(const BatchCatalog&, const LocalRun&, Progress&);

}  // namespace cei3d
