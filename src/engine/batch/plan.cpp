// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/plan.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/base/cancel.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// A folder's name as an id.
std::string id_from(const fs::path& capture) {
  const fs::path path = fs::absolute(capture).lexically_normal();
  std::error_code error;
  fs::path folder = fs::is_regular_file(path, error) ? path.parent_path() : path;
  if (!folder.has_filename()) folder = folder.parent_path();
  std::string id = folder.filename().string();
  for (char& c : id)
    if (!is_batch_id(std::string("x") + c)) c = '_';
  constexpr size_t kRoom = 90;
  id = id.substr(0, kRoom);
  return is_batch_id(id) ? id : "object_" + id;
}

bool is_list(const fs::path& path) { return path.extension() == ".jsonl" || path.extension() == ".csv"; }

// Rough: fits the peaks of the objects in docs/notebook/benchmarks.md within a third.
double memory_of(const CheckReport& r) {
  constexpr double kProgram = 0.3, kPerMegapixel = 0.03;
  double megapixels = 0;
  for (const View& v : views_of(r.capture, Split::train))
    megapixels += 1e-6 * v.camera.width * v.camera.height;
  return kProgram + kPerMegapixel * megapixels;
}

void plan_capture(const BatchItem& item, Json& line, Session& session, BatchPlan& plan) {
  try {
    const CheckReport r = session.check({item.capture, item.capture_options, {}});
    require_usable(r.report);
    const double memory = std::round(100 * memory_of(r)) / 100;
    line["planned"] = {{"views", r.capture.views.size()}, {"memory_gib", memory}};
    plan.views += r.capture.views.size();
    plan.memory_gib = std::max(plan.memory_gib, memory);
  } catch (const Error& e) {  // a capture that is refused does not keep others from being planned
    plan.refused.push_back({item.id, e.what()});
  }
}

std::vector<Json> lines_of(const std::vector<fs::path>& captures) {
  std::vector<Json> lines;
  std::unordered_map<std::string, int> used;
  if (captures.size() == 1 && is_list(captures[0])) {
    const BatchManifest manifest = BatchManifest::read(captures[0]);
    for (size_t i = 0; i < manifest.size(); ++i) lines.push_back(manifest.line(i));
    return lines;
  }
  for (const fs::path& capture : captures) {
    std::string id = id_from(capture);
    const int before = used[id]++;
    if (before > 0) id += fmt::format("-{}", before + 1);
    lines.push_back({{"id", id}, {"capture", fs::absolute(capture).lexically_normal().string()}});
  }
  return lines;
}

}  // namespace

Json BatchPlan::json() const {
  Json list = Json::array();
  for (const BatchRefusal& r : refused) list.push_back({{"id", r.id}, {"sentence", r.reason}});
  return {{"objects", lines.size()}, {"views", views}, {"memory_gib", memory_gib}, {"refused", list}};
}

BatchPlan batch_plan(const std::vector<fs::path>& captures, bool look, Session& session, Progress& progress) {
  BatchPlan plan;
  plan.lines = lines_of(captures);
  for (size_t i = 0; i < plan.lines.size(); ++i) {
    check_cancelled(progress);
    Json& line = plan.lines[i];
    const BatchItem item = batch_item_from(line, fmt::format("Object {}", i));
    if (look && !item.capture.empty()) plan_capture(item, line, session, plan);
    progress.report({"plan", double(i + 1) / double(plan.lines.size()), -1, item.id});
  }
  return plan;
}

}  // namespace cei3d
