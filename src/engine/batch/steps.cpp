// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/steps.h"

#include <algorithm>
#include <thread>

#include "core/base/cancel.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "engine/batch/variant.h"
#include "engine/project/project.h"
#include "engine/session/version.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Keys in the order of the alphabet, so that the order in a manifest does not matter.
std::string key_of(const Json& json) { return content_hash(nlohmann::json(json).dump()); }

Json run_check(const BatchItem& item, const BatchStepTools& tools) {
  const CheckReport r = tools.session.check({item.capture, item.capture_options, {}});
  require_usable(r.report);
  Json warnings = Json::array();
  for (const Finding& f : r.report.findings)
    if (f.severity == Severity::warning) warnings.push_back(f.what);
  return {{"views", r.capture.views.size()}, {"warnings", warnings}};
}

Json run_reconstruct(const BatchItem& item, const BatchStepTools& tools, const fs::path& out) {
  ReconstructRequest r;
  r.capture = item.capture;
  r.project = out;
  r.format = item.capture_options.format;
  r.strict = item.capture_options.strict;
  r.options = item.options;
  r.resume = Project::is_project(out);
  const ReconstructReport report = tools.session.reconstruct(r, tools.progress);
  tools.session.close();
  return {{"vertices", report.vertices},
          {"material", report.object.material_text()},
          {"warning", report.object.warning()}};
}

constexpr int kThumbnail = 192;  // pixels

Json run_figures(const BatchStepTools& tools, const fs::path& out) {
  Session& session = tools.session;
  session.open(tools.results("project"), Session::Access::read);
  RenderRequest picture;
  picture.out = out / "render";
  picture.cameras = Turntable{1};
  picture.width = picture.height = kThumbnail;
  session.render(picture, tools.progress);
  for (const auto& file : fs::directory_iterator(picture.out / "rgb"))
    fs::rename(file, out / "thumbnail.png");
  fs::remove_all(picture.out);
  const EvalReport r = session.evaluate({}, tools.progress);
  write_file_atomic(out / "scores.json", r.json().dump(1) + "\n");
  Json j{{"psnr", r.psnr},
         {"psnr_worst", r.psnr_worst},
         {"worst_view", r.worst_view},
         {"ssim", r.ssim},
         {"psnr_masked", r.psnr_masked}};
  if (r.alone) j["psnr_alone"] = r.alone->psnr;
  session.close();
  return j;
}

Json run_export(const BatchItem& item, const std::string& source, const BatchStepTools& tools,
                const fs::path& out) {
  tools.session.open(tools.results(source), Session::Access::read);
  Json files = Json::array();
  ExportRequest r;
  for (const std::string& kind : item.exports) {
    files.push_back(item.id + "." + kind);
    r.out.push_back(out / (item.id + "." + kind));
  }
  r.purpose = export_for_from_name(item.purpose).value_or(ExportFor::any);
  // Pages and lights store no scale; the session refuses unit_scale where no file can hold it.
  if (std::any_of(r.out.begin(), r.out.end(), holds_placed_object)) r.unit_scale = item.unit_scale;
  tools.session.export_to(r, tools.progress);
  tools.session.close();
  return {{"files", files}};
}

Json run_turntable(const BatchItem& item, const std::string& source, const BatchStepTools& tools,
                   const fs::path& out) {
  tools.session.open(tools.results(source), Session::Access::read);
  RenderRequest r;
  r.out = out;
  r.cameras = Turntable{item.frames};
  tools.session.render(r, tools.progress);
  tools.session.close();
  std::string first;
  for (const auto& file : fs::directory_iterator(out / "rgb"))
    if (const std::string name = file.path().filename().string(); first.empty() || name < first) first = name;
  return {{"picture", "rgb/" + first}};
}

Json run_stub(const BatchItem& item, const BatchStepTools& tools) {
  constexpr auto kPiece = std::chrono::milliseconds(5);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(item.stub_seconds);
  while (std::chrono::steady_clock::now() < end) {
    check_cancelled(tools.progress);
    std::this_thread::sleep_for(kPiece);
  }
  return Json::object();
}

bool wants(const BatchItem& item, const char* step) {
  return std::find(item.steps.begin(), item.steps.end(), step) != item.steps.end();
}

void add_results_of(const BatchItem& item, const std::string& variant, const BatchStep& source,
                    BatchSteps& out) {
  if (wants(item, "export"))
    out.steps.push_back({"export/" + variant,
                         key_of({"export", source.key, item.asset}),
                         {source.name},
                         true,
                         [&item, name = source.name](const BatchStepTools& t, const fs::path& o) {
                           return run_export(item, name, t, o);
                         }});
  if (wants(item, "turntable"))
    out.steps.push_back({"turntable/" + variant,
                         key_of({"turntable", source.key, item.frames}),
                         {source.name},
                         true,
                         [&item, name = source.name](const BatchStepTools& t, const fs::path& o) {
                           return run_turntable(item, name, t, o);
                         }});
}

bool needs_object(const BatchItem& item) {
  for (const char* step : {"reconstruct", "figures", "export", "turntable"})
    if (wants(item, step)) return true;
  return false;
}

BatchStep project_step(const BatchItem& item, const std::string& capture_hash) {
  return {"project",
          key_of({kResultVersion, capture_hash, item.capture_reading, item.reconstruction}),
          {},
          item.keep != BatchKeep::exports,
          [&item](const BatchStepTools& t, const fs::path& o) { return run_reconstruct(item, t, o); }};
}

void add_object_steps(const BatchItem& item, const BatchStep& project, Session& session, BatchSteps& out) {
  out.steps.push_back(project);
  if (wants(item, "figures"))
    out.steps.push_back({"figures",
                         key_of({"figures", project.key}),
                         {"project"},
                         true,
                         [](const BatchStepTools& t, const fs::path& o) { return run_figures(t, o); }});
  add_results_of(item, "original", project, out);
  for (const BatchVariant& v : item.variants) {
    const std::string key = key_of({"variant", project.key, variant_inputs(v, session)});
    const BatchStep step{"variant/" + v.name,
                         key,
                         {"project"},
                         item.keep == BatchKeep::all,
                         [&v](const BatchStepTools& t, const fs::path& o) {
                           return make_variant(v, t.results("project"), o, t.session, t.progress);
                         }};
    out.steps.push_back(step);
    add_results_of(item, v.name, step, out);
  }
}

}  // namespace

const BatchStep& BatchSteps::named(const std::string& name) const {
  for (const BatchStep& s : steps)
    if (s.name == name) return s;
  fail("There is no step {} (an error in the program).", name);
}

std::string capture_files_hash(const fs::path& capture) {
  std::error_code error;
  const fs::path folder = fs::is_directory(capture, error) ? capture : capture.parent_path();
  std::vector<std::string> lines;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->is_regular_file(error))
      lines.push_back(fmt::format("{} {} {}\n", fs::relative(it->path(), folder, error).string(),
                                  it->file_size(error),
                                  it->last_write_time(error).time_since_epoch().count()));
  if (error || lines.empty() || !fs::exists(capture, error)) return "";
  std::sort(lines.begin(), lines.end());
  std::string all;
  for (const std::string& line : lines) all += line;
  return content_hash(all);
}

BatchSteps batch_steps(const BatchItem& item, const std::string& capture_hash, Session& session) {
  BatchSteps out;
  if (wants(item, "check"))
    out.steps.push_back({"check",
                         key_of({"check", capture_hash, item.capture_reading}),
                         {},
                         true,
                         [&item](const BatchStepTools& t, const fs::path&) { return run_check(item, t); }});
  if (needs_object(item)) add_object_steps(item, project_step(item, capture_hash), session, out);
  if (wants(item, "stub"))
    out.steps.push_back({"stub",
                         key_of({"stub", item.stub_seconds}),
                         {},
                         true,
                         [&item](const BatchStepTools& t, const fs::path&) { return run_stub(item, t); }});
  Json keys = Json::array();
  for (const BatchStep& s : out.steps)
    if (s.kept) keys.push_back({s.name, s.key});
  out.key = key_of(keys);
  return out;
}

}  // namespace cei3d
