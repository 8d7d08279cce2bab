// SPDX-License-Identifier: Apache-2.0
// The unit of work of a catalog: an object, made once, whoever asks for it and however often.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/batch/manifest.h"
#include "engine/session/session.h"

namespace cei3d {

enum class BatchResult {
  done,         // made now
  already,      // nothing was to be made
  failed,       // and would fail again
  again,        // failed by a cause that may pass
  taken,        // another worker has it
  interrupted,  // saved
};

const char* batch_result_name(BatchResult);

struct BatchWorkReport {
  std::string id;
  BatchResult result = BatchResult::done;
  std::string sentence;  // why not done
  double seconds = 0;
  Json json() const;
};

// Errors are in the report, except those of the catalog itself.
BatchWorkReport batch_work(const BatchCatalog&, const BatchManifest&, size_t index, Session&, Progress&);

// Works on objects that nobody else works on until none is left, beginning somewhere in the manifest.
std::vector<BatchWorkReport> batch_claim(const BatchCatalog&, const BatchManifest&, Session&, Progress&);

// Whether nothing is to be made: the object is done, or failed for good, with the present key.
// gone: its capture is not there any more.
bool batch_is_settled(const std::optional<BatchState>&, const std::string& key, bool gone);

}  // namespace cei3d
