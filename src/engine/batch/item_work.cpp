// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/item_work.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/base/parse_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStepFile = "step.json";

// What a step found, if its folder holds its results; else null: it is made again.
Json found_in(const fs::path& folder, const std::string& key) {
  std::error_code error;
  if (!fs::exists(folder / kStepFile, error)) return nullptr;
  const Json j = parse_json(read_file(folder / kStepFile));
  const bool known = j.is_object() && j.size() == 2 && j.contains("key") && j.contains("found");
  return known && j["key"] == key ? j["found"] : Json();
}

class ItemWork {
 public:
  ItemWork(const BatchSteps& steps, BatchAttempt& attempt, Session& session, Progress& progress)
      : steps_(steps), attempt_(attempt), session_(session), progress_(progress) {}

  Json all() {
    Json out = Json::object();
    for (const BatchStep& step : steps_.steps)
      if (step.kept) out[step.name] = made(step);
    return out;
  }

 private:
  // Makes the step, if that is not done, and before it those that it needs.
  Json made(const BatchStep& step) {
    if (Json found = found_in(attempt_.item() / step.name, step.key); !found.is_null()) return found;
    const fs::path out = attempt_.work() / step.name;
    if (found_in(out, step.key).is_null()) {
      for (const std::string& needed : step.needs) made(steps_.named(needed));
      check_cancelled(progress_);
      run(step, out);
    }
    if (step.kept) attempt_.publish(step.name);
    return found_in(folder_of(step), step.key);
  }

  void run(const BatchStep& step, const fs::path& out) {
    // What an earlier attempt has begun is of use only for the same key.
    std::string plain = step.name;
    std::replace(plain.begin(), plain.end(), '/', '-');
    const fs::path begun = attempt_.work() / (plain + ".key");
    std::error_code error;
    if (!fs::exists(begun, error) || read_file(begun) != step.key) {
      fs::remove_all(out);
      write_file_atomic(begun, step.key);
    }
    fs::create_directories(out.parent_path());
    const double start = steady_seconds();
    const BatchStepTools tools{session_, progress_,
                               [this](const std::string& name) { return folder_of(steps_.named(name)); }};
    Json found = step.run(tools, out);
    found["seconds"] = steady_seconds() - start;
    write_file_atomic(out / kStepFile, Json{{"key", step.key}, {"found", found}}.dump(1) + "\n");
  }

  fs::path folder_of(const BatchStep& step) const {
    const fs::path published = attempt_.item() / step.name;
    return found_in(published, step.key).is_null() ? attempt_.work() / step.name : published;
  }

  const BatchSteps& steps_;
  BatchAttempt& attempt_;
  Session& session_;
  Progress& progress_;
};

}  // namespace

Json make_item(const BatchSteps& steps, BatchAttempt& attempt, Session& session, Progress& progress) {
  return ItemWork(steps, attempt, session, progress).all();
}

}  // namespace cei3d
