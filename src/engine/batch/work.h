// SPDX-License-Identifier: Apache-2.0
// Makes one object of a catalog. A call for an object that is done changes nothing, and several workers may
// call at the same time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/batch/manifest.h"
#include "engine/session/session.h"

namespace cei3d {

enum class BatchResult {
  done,         // this call has made the object
  up_to_date,   // the object was done before
  failed,       // the same attempt would fail again
  retryable,    // the attempt failed by a cause that may pass
  in_use,       // another worker has the object
  interrupted,  // what was made so far is saved
};

const char* batch_result_name(BatchResult);

struct BatchWorkReport {
  std::string id;
  BatchResult result = BatchResult::done;
  std::string reason;  // a sentence: why the object was not made
  double seconds = 0;
  Json json() const;
};

// Errors are in the report, except those of the catalog itself.
BatchWorkReport batch_work(const BatchCatalog&, const BatchManifest&, size_t index, Session&, Progress&);

// Works on the objects that no other worker has, until none is left, beginning somewhere in the manifest.
std::vector<BatchWorkReport> batch_claim(const BatchCatalog&, const BatchManifest&, Session&, Progress&);

// Whether there is nothing to make: the object is done, or has failed for good, with the present key. gone:
// its capture is not there any more; an object that is done then stays.
bool batch_is_settled(const std::optional<BatchState>&, const std::string& key, bool gone);

}  // namespace cei3d
