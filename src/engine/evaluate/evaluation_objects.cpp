// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluation_objects.h"

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/project/dataset.h"
#include "engine/project/project.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

Json options_json(const ReconstructOptions& o) {
  return {{"preset", o.preset},       {"seconds", o.seconds}, {"iterations", o.iterations},
          {"seed", o.seed},           {"views", o.views},     {"test_every", o.test_every},
          {"downscale", o.downscale}, {"set", o.set},         {"test_share", o.test_share}};
}

}  // namespace

std::string full_path(const fs::path& p) { return p.empty() ? "" : fs::weakly_canonical(p).string(); }

EvaluationObjects::EvaluationObjects(Session& session, const EvaluationRequest& request)
    : session_(session), r_(request), kept_(request.out / "objects"), capture_(full_path(request.capture)) {
  if (Project::is_project(r_.out))
    fail_usage("{} is a project; name another folder for the report.", r_.out.string());
  ReconstructOptions all = r_.options;
  all.views = 0;
  loaded_ = load_capture(r_.capture, capture_options(r_.format, all));
  const Capture& capture = loaded_;
  training_views_ = int(views_of(capture, Split::train).size());
  fingerprint_ = capture_fingerprint(capture);
  if (r_.paint) find_view(capture, r_.paint->view);
  if (r_.part) find_view(capture, r_.part->command.view);
  if (!r_.project.empty()) given_ = describe_given(capture);
}

// Distinguishes objects in that folder.
Json EvaluationObjects::describe_given(const Capture& capture) {
  session_.open(r_.project, Session::Access::read);
  const ProjectInfo info = session_.info();
  session_.close();
  if (!info.finished)
    fail("Project {} holds no finished object; resume its reconstruction.", r_.project.string());
  if (full_path(info.capture_root) != full_path(capture.root))
    fail_usage("{} is an object of the capture {}, not of {}.", r_.project.string(),
               info.capture_root.string(), capture.root.string());
  return {{"path", full_path(r_.project)},
          {"options", info.options},
          {"vertices", info.vertices},
          {"handler_points", info.handler_points},
          {"roughness", info.object.mean.roughness}};
}

EvaluationObject EvaluationObjects::whole() const { return {"whole", r_.options, !r_.project.empty()}; }

EvaluationObject EvaluationObjects::with(const ReconstructOptions& o) const {
  if (r_.project.empty() && options_json(o) == options_json(r_.options)) return whole();
  std::string name = "trial";
  if (o.views > 0) name += fmt::format("-views-{}", o.views);
  if (o.downscale > 1) name += fmt::format("-size-{}", o.downscale);
  return {name, o, false};
}

Json EvaluationObjects::settings(const EvaluationObject& o) const {
  Json j = {{"capture", capture_}, {"fingerprint", fingerprint_}, {"format", r_.format}};
  if (o.given)
    j["project"] = given_;
  else
    j["options"] = options_json(o.options);
  return j;
}

// The settings are written before the work, so that an unfinished object with other settings is not resumed.
double EvaluationObjects::open(const EvaluationObject& o, Progress& progress) {
  const fs::path folder = r_.out / "objects" / o.name;
  const Json settings = this->settings(o);
  Json kept = kept_.find(o.name, settings);
  session_.close();
  if (kept.is_null()) {
    fs::remove_all(folder);
    kept = Json::object();
    kept_.put(o.name, settings, kept);
  }
  if (!kept.contains("seconds")) {
    kept["seconds"] = make(o, folder, progress);
    kept_.put(o.name, settings, kept);
  }
  session_.open(folder, Session::Access::write);
  const std::vector<LogEntry> log = session_.log();
  for (size_t i = 0; i < log.size() && log[i].done; ++i) session_.undo(progress);
  return kept.at("seconds").get<double>();
}

double EvaluationObjects::make(const EvaluationObject& o, const fs::path& folder, Progress& progress) {
  const bool begun = !o.given && Project::is_project(folder);
  if (!begun) fs::remove_all(folder);  // remains of an interrupted copy or start
  if (o.given) {
    fs::create_directories(folder.parent_path());
    fs::copy(r_.project, folder, fs::copy_options::recursive);
    return 0;
  }
  ReconstructRequest request;
  request.capture = r_.capture;
  request.project = folder;
  request.format = r_.format;
  request.options = o.options;
  request.resume = begun;
  return session_.reconstruct(request, progress).seconds;
}

}  // namespace cei3d
