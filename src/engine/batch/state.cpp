// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/state.h"

#include <array>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/base/parse_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// In the order of the enumerators. Catalogs store these words.
constexpr std::array<const char*, 5> kOutcomes{"waiting", "done", "failed", "again", "interrupted"};
constexpr std::array<const char*, 5> kCauses{"none", "input", "memory", "machine", "killed"};

template <class Enum>
Enum named(const std::array<const char*, 5>& names, const std::string& name, const std::string& what) {
  for (size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) return Enum(i);
  fail("{} is damaged: '{}' means nothing here.", what, name);
}

BatchState state_from(const Json& j, const std::string& what) {
  JsonReader r(j, what);
  BatchState s;
  s.outcome = named<BatchOutcome>(kOutcomes, r.require<std::string>("state"), what);
  s.cause = named<BatchCause>(kCauses, r.require<std::string>("cause"), what);
  s.key = r.require<std::string>("key");
  s.reason = r.require<std::string>("sentence");
  s.attempt = r.require<int>("attempt");
  s.tries = r.require<int>("tries");
  s.memory_doublings = r.require<int>("memory_doublings");
  s.seconds = r.require<double>("seconds");
  s.peak_memory_gib = r.require<double>("peak_memory_gib");
  s.ended = r.require<int64_t>("ended");
  s.host = r.require<std::string>("host");
  s.result = r.member("result");
  r.finish();
  return s;
}

}  // namespace

const char* batch_outcome_name(BatchOutcome o) { return kOutcomes[size_t(o)]; }
const char* batch_cause_name(BatchCause c) { return kCauses[size_t(c)]; }

Json BatchState::json() const {
  return {{"state", batch_outcome_name(outcome)},
          {"cause", batch_cause_name(cause)},
          {"key", key},
          {"sentence", reason},
          {"attempt", attempt},
          {"tries", tries},
          {"memory_doublings", memory_doublings},
          {"seconds", seconds},
          {"peak_memory_gib", peak_memory_gib},
          {"ended", ended},
          {"host", host},
          {"result", result}};
}

fs::path batch_item_folder(const fs::path& catalog, const std::string& id) {
  return catalog / "items" / content_hash(id).substr(0, 2) / id;
}

std::optional<BatchState> read_batch_state(const fs::path& item_folder) {
  const fs::path file = item_folder / "state.json";
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  const Json j = parse_json(read_file(file));
  if (j.is_discarded()) fail("{} is damaged; remove it, and the object is made again.", file.string());
  return state_from(j, file.string());
}

}  // namespace cei3d
