// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluation_set.h"

#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/evaluate/evaluation_objects.h"
#include "engine/evaluate/own_edits.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Names of the captures' folders; equal ones are numbered.
std::vector<std::string> names_of(const std::vector<fs::path>& captures) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const fs::path& c : captures) {
    const fs::path full = fs::weakly_canonical(c);
    const std::string stem =
        fs::is_directory(full) ? full.filename().string() : full.parent_path().filename().string();
    std::string name = stem;
    for (int n = 2; taken.count(name); ++n) name = fmt::format("{}-{}", stem, n);
    taken.insert(name);
    names.push_back(name);
  }
  return names;
}

EvaluationRequest request_for(const EvaluationSetRequest& set, const fs::path& capture, const fs::path& out) {
  EvaluationRequest r = set.each;
  r.capture = capture;
  if (r.paint || r.part) return r;  // given for this one capture
  OwnEdits own = own_edits(capture);
  if (own.part && r.parts) r.part = own.part;
  if (!own.paint)
    own.paint =
        made_scribble(load_capture(capture, capture_options(r.format, r.options)), out / "scribble.png");
  r.paint = own.paint;
  r.paint_truth = own.paint_truth;
  return r;
}

void save(const EvaluationSetReport& report, const fs::path& out) {
  write_file_atomic(out / "report.json", report.json().dump(1) + "\n");
  write_file_atomic(out / "report.md", report.markdown());
}

}  // namespace

EvaluationSetReport evaluate_captures(Session& session, const EvaluationSetRequest& set, Progress& progress) {
  const std::vector<std::string> names = names_of(set.captures);
  EvaluationSetReport report;
  for (size_t i = 0; i < names.size(); ++i) {
    EvaluatedCapture evaluated{names[i], "", {}};
    const fs::path folder = set.each.out / names[i];
    try {
      EvaluationRequest r = request_for(set, set.captures[i], folder);
      for (int s = 0; s < set.seeds; ++s) {
        r.options.seed = set.each.options.seed + uint64_t(s);
        r.out = set.seeds == 1 ? folder : folder / fmt::format("seed-{}", r.options.seed);
        evaluated.reports.push_back(evaluate_capture(session, r, progress));
      }
    } catch (const Error& e) {
      if (e.code() != ErrorCode::failed || names.size() == 1) throw;
      evaluated.failed = e.what();
      progress.log(Json{{"capture", names[i]}, {"failed", e.what()}}.dump());
    }
    report.captures.push_back(std::move(evaluated));
    save(report, set.each.out);
  }
  if (set.boards) write_boards(report, set.each.out);
  return report;
}

}  // namespace cei3d
