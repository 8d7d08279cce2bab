// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string capture, project, time;
  ReconstructRequest request;
};

void run_reconstruct(const Options& o, Session& session, Console& console) {
  ReconstructRequest request = o.request;
  if (o.capture.empty() && !request.resume)
    fail_usage("reconstruct needs a CAPTURE, or --resume to go on with a project.");
  if (!o.capture.empty()) request.capture = parse_capture_spec(o.capture).path;
  request.project = o.project;
  if (!o.time.empty()) request.options.seconds = parse_duration(o.time);
  const ReconstructReport r = session.reconstruct(request, console);
  console.done(
      r.json(),
      fmt::format(
          "{}: object of {} vertices and {} handler points from {} views in {}; roughness {:.2f}, {}.",
          o.project, r.vertices, r.handler_points, r.views, duration_text(r.seconds), r.material.roughness,
          r.material.metalness > 0.5f ? "metal" : "dielectric"));
}

}  // namespace

void add_reconstruct(Commands& commands) {
  auto o = std::make_shared<Options>();
  ReconstructOptions& options = o->request.options;
  CLI::App* verb = commands.add("reconstruct", "Make an editable object (a project) from posed photographs");
  verb->add_option("capture", o->capture,
                   "Folder of posed photographs, or its .json or .npz; not needed with --resume");
  verb->add_option("-o,--output", o->project, "Folder of the project to make")->required();
  verb->add_option("--preset", options.preset, "Size of the networks and length of the schedule")
      ->check(CLI::IsMember({"fast", "balanced", "paper"}))
      ->capture_default_str();
  CLI::Option* time = verb->add_option(
      "--time", o->time, "Stop training after: seconds, or 90s, 10m, 1h30m (default: the preset's own)");
  verb->add_option("--iterations", options.iterations,
                   "Length of the geometry stage in steps, in place of --time; 0: unset")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->excludes(time);
  verb->add_option("--seed", options.seed,
                   "Of everything random; the same seed and --iterations give the same object")
      ->capture_default_str();
  verb->add_option("--downscale", options.downscale, "Use the pictures at 1/N of their size")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--test-every", options.test_every,
                   "Hold out every Nth view when the capture has no test split; 0: none")
      ->capture_default_str();
  verb->add_option(
          "--views", options.views,
          "Train on N views only, spread evenly, to see how many are needed; the others are validation "
          "views; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--format", o->request.format,
                   "nerf-synthetic, physg or idr (default: told by the files)");
  CLI::Option* resume =
      verb->add_flag("--resume", o->request.resume,
                     "Go on where the project's training was interrupted, with its own options");
  verb->add_flag("--force", o->request.replace,
                 "Replace the project that is in the folder, its edits included")
      ->excludes(resume);
  commands.on(verb, o, run_reconstruct);
}

}  // namespace cei3d
