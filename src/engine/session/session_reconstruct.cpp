// SPDX-License-Identifier: Apache-2.0
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "core/base/system.h"
#include "core/compute/device.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/check.h"
#include "engine/io/image_file.h"
#include "engine/project/dataset.h"
#include "engine/project/project.h"
#include "engine/reconstruct/preset_settings.h"
#include "engine/render/render_cache.h"
#include "engine/session/cameras.h"
#include "engine/session/object_summary.h"
#include "engine/session/photograph_size.h"
#include "engine/session/run_log.h"
#include "engine/session/session.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

class ProjectCheckpoints : public Checkpoints {
 public:
  explicit ProjectCheckpoints(Project& project) : project_(project) {}
  void save(const State& s) override { project_.save_checkpoint({s.head, s.tensors}); }
  std::optional<State> latest() override {
    std::optional<TrainingState> s = project_.latest_checkpoint();
    if (!s) return std::nullopt;
    return State{std::move(s->head), std::move(s->tensors)};
  }

 private:
  Project& project_;
};

Json options_json(const ReconstructRequest& r) {
  const ReconstructOptions& o = r.options;
  return {{"preset", o.preset},
          {"seconds", o.seconds},
          {"iterations", o.iterations},
          {"joint_steps", o.joint_steps},
          {"seed", o.seed},
          {"downscale", o.downscale},
          {"test_every", o.test_every},
          {"test_share", o.test_share},
          {"light_color", light_color_text(o.light_color)},
          {"views", o.views},
          {"light", o.light ? light_motion_name(*o.light) : "auto"},
          {"refine_poses", o.refine_poses},
          {"fit_exposures", o.fit_exposures},
          {"set", o.set},
          {"format", r.format}};
}

ReconstructOptions options_from_json(const Json& j) {
  JsonReader reader(j, "The options of the reconstruction");
  ReconstructOptions o;
  o.preset = reader.require<std::string>("preset");
  o.seconds = reader.require<double>("seconds");
  o.iterations = reader.require<int>("iterations");
  o.joint_steps = reader.optional("joint_steps", 0);  // missing in older projects
  o.seed = reader.require<uint64_t>("seed");
  o.downscale = reader.require<int>("downscale");
  o.test_every = reader.require<int>("test_every");
  o.test_share = reader.optional("test_share", 0.0);
  o.views = reader.optional("views", 0);                                        // missing in older projects
  o.light = light_motion_named(reader.optional("light", std::string("auto")));  // missing in older projects
  o.light_color = light_color_from(reader.optional("light_color", std::string())).value_or(LightColorPrior());
  o.refine_poses = reader.optional("refine_poses", true);
  o.fit_exposures = reader.optional("fit_exposures", true);
  if (reader.has("set")) o.set = reader.member("set");
  check_settings(preset_settings().infos(), o.set);
  reader.has("format");
  reader.finish();
  return o;
}

// Error: the machine has too little memory for it.
int usable_downscale(int asked, const CaptureReport& report) {
  const int n = asked > 0 ? asked : default_downscale(report);
  const double needed = reconstruction_gib(report, n), there = memory_gib();
  int views = 0;
  for (const SplitReport& s : report.splits)
    if (s.split == Split::train) views = s.views;
  if (there == 0 || needed < there) return n;
  throw Error(ErrorCode::failed,
              fmt::format("{} views{} need about {:.1f} GiB of memory; this machine has {:.1f}.", views,
                          n > 1 ? fmt::format(" at 1/{} of their size", n) : "", needed, there),
              fmt::format("Use them smaller (downscale {}), or fewer of them (views).", n + 1));
}

// Checks as `check` does, so that nothing is written for an unusable capture.
Project create_project(const ReconstructRequest& request, const CheckReport& checked) {
  require_usable(checked.report);
  Capture capture = checked.capture;
  const auto file_of = [&](const std::string& view) {
    return request.project / "doubtful" / (view + ".png");
  };
  for (const CaptureReport::Doubt& d : checked.report.doubts)
    for (View& v : capture.views)
      if (v.name == d.view) v.doubtful_path = file_of(d.view);
  ReconstructRequest sized = request;
  sized.options.downscale = usable_downscale(request.options.downscale, checked.report);
  Project project = Project::create(request.project, {*checked.report.normalization, options_json(sized)},
                                    capture, request.replace);
  for (const CaptureReport::Doubt& d : checked.report.doubts) {
    const Camera& c = find_view(capture, d.view).camera;
    Image picture(c.width, c.height, 1);
    for (size_t i = 0; i < d.area.size(); ++i) picture.data[i] = d.area[i];
    write_png(file_of(d.view), picture);
  }
  return project;
}

// Error: the capture has changed since the reconstruction began.
void require_same_capture(const Project& project, const fs::path& given) {
  Capture now = project.given_capture();
  if (!given.empty()) now = load_capture(given, reading_of(project));
  if (capture_fingerprint(now) != project.fingerprint())
    fail(
        "The capture {} has changed since {} was begun: its views, cameras or images differ. Restore "
        "it, or start anew, in place of it.",
        now.root.string(), project.folder().string());
}

ReconstructReport report_of(const Device& device, const Project& project, const Scene& scene,
                            double seconds) {
  ReconstructReport r;
  r.seconds = seconds;
  r.views = views_of(project.capture(), Split::train).size();
  r.downscale = project.head().options.value("downscale", 1);
  r.handler_points = scene.handlers ? scene.handlers->positions.size() : 0;
  r.vertices = scene.surface ? scene.surface->mesh().positions.size() : 0;
  r.object = summary_of(device, scene);
  return r;
}

}  // namespace

ReconstructReport Session::run_reconstruction(const ReconstructRequest& request, Progress& progress) {
  const double start = steady_seconds();
  if (request.resume) {
    open(request.project, Access::write);
    require_same_capture(project(), request.capture);
    if (project().has_base()) return report_of(*device_, project(), project().base(), 0);
  } else {
    Project::check_place(request.project, request.replace);
    const ReconstructOptions& o = request.options;
    CaptureOptions loading = capture_options(request.format, o);
    loading.strict = request.strict;
    const CheckReport checked = check({request.capture, loading, {}});
    project_.reset();
    project_ = std::make_unique<Project>(create_project(request, checked));
    say_address(address_);
  }
  try {
    const ReconstructOptions options = options_from_json(project().head().options);
    const fs::path run = project().new_run("reconstruct");
    project().add_history(
        {{"do", request.resume ? "resume" : "reconstruct"}, {"options", project().head().options}});
    RunLog log(progress, run / "log.jsonl");
    ProjectCheckpoints checkpoints(project());
    const Scene scene =
        cei3d::reconstruct(*device_, project().capture(), CaptureImages(options.downscale),
                           project().head().normalization, options, checkpoints, log, request.show);
    project().save_base(scene);
    begin_frames(Access::write);
    // Otherwise the first picture of the object would wait for this light.
    frames_->light_to_keep(project().scene());
    return report_of(*device_, project(), scene, steady_seconds() - start);
  } catch (...) {
    project().discard_if_empty();
    throw;
  }
}

}  // namespace cei3d
