// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "engine/capture/capture.h"

namespace cei3d {
namespace {

struct Options {
  std::string capture, project, time, light = "auto", light_color = "near-white", poses = "auto",
                                      exposures = "auto";
  std::vector<std::string> set;
  std::string split;
  bool list_settings = false;
  ReconstructRequest request;
};

void list_settings(const Options& o, Console& console) {
  const SettingsReport r = settings_of_preset(o.request.options.preset);
  console.answer(r.json(), r.text());
}

// Reconstructs; adds the command that resumes the run to the error of an interrupted one.
ReconstructReport reconstructed(const ReconstructRequest& r, Session& session, Console& console) {
  try {
    return session.reconstruct(r, console);
  } catch (const Error& e) {
    if (e.code() != ErrorCode::interrupted || e.hint().empty()) throw;
    throw Error(e.code(), e.what(),
                fmt::format("`cei3d reconstruct -o {} --resume` goes on.", r.project.string()));
  }
}

void run_reconstruct(const Options& o, Session& session, Console& console) {
  if (o.list_settings) return list_settings(o, console);
  ReconstructRequest request = o.request;
  if (o.project.empty()) fail_usage("reconstruct needs a project folder to create: -o PROJECT.");
  if (request.resume && !o.set.empty())
    fail_usage("--resume continues with the settings of the project; leave out --set.");
  request.options.set = settings_from_text(o.set);
  if (!o.split.empty()) parse_split(o.split, request.options);
  if (o.capture.empty() && !request.resume)
    fail_usage("reconstruct needs a CAPTURE, or --resume to continue a project.");
  if (!o.capture.empty()) request.capture = parse_capture_spec(o.capture).path;
  request.project = o.project;
  request.options.light = light_motion_named(o.light);
  const auto color = light_color_from(o.light_color);
  if (!color) fail_usage("--light-color is free, near-white or three numbers above 0, as in 1,0.9,0.8.");
  request.options.light_color = *color;
  request.options.refine_poses = o.poses == "auto";
  request.options.fit_exposures = o.exposures == "auto";
  if (!o.time.empty()) request.options.seconds = parse_duration(o.time);
  const ReconstructReport r = reconstructed(request, session, console);
  console.done(r.json(),
               fmt::format("{}: object of {} vertices and {} handler points from {} views{} in {}; {}.{}{}",
                           o.project, r.vertices, r.handler_points, r.views,
                           r.downscale > 1 ? fmt::format(" at 1/{} of their size", r.downscale) : "",
                           duration_text(r.seconds), r.object.text(), r.object.warning().empty() ? "" : "\n",
                           r.object.warning()));
}

void add_schedule_options(CLI::App* verb, Options& o) {
  ReconstructOptions& options = o.request.options;
  verb->add_option(
          "--preset", options.preset,
          "fast: small networks, minutes. balanced: a deeper network and hash tables four times as "
          "large, for a quarter of an hour and more. paper: the paper's own method, everything "
          "by one descent from a sphere, with its network sizes; days on two cores unless --time is given")
      ->check(CLI::IsMember({"fast", "balanced", "paper"}))
      ->capture_default_str();
  CLI::Option* time =
      verb->add_option("--time", o.time,
                       "Time for the whole reconstruction: seconds, or 90s, 10m, 1h30m; the schedule is "
                       "fitted to it (default: the preset's number of steps, see --iterations)");
  verb->add_option(
          "--iterations", options.iterations,
          "Steps of the geometry stage (paper: of its only descent), instead of --time; 0: the preset's, "
          "4000 (fast), 16000 (balanced), 200000 (paper)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->excludes(time);
  verb->add_option(
          "--joint", options.joint_steps,
          "Steps, at most, of a last descent on surface, albedo, material and light together, which is "
          "kept if it explains pixels better that it has not seen; 0: none; -1: the preset's, which is 0 in "
          "all of them")
      ->check(CLI::Range(-1, 1000000))
      ->capture_default_str();
  verb->add_option("--seed", options.seed,
                   "Random seed. Without --time the same seed gives the same object, bit for bit")
      ->capture_default_str();
}

void add_settings(CLI::App* verb, Options& o) {
  verb->add_option("--set", o.set,
                   "key=value: a number or choice of the preset; repeatable. @FILE.json: a file that holds "
                   "{\"set\": {\"key\": value, ...}}")
      ->expected(1)
      ->take_all();
  verb->add_flag("--list-settings", o.list_settings,
                 "List what --set can change, with the preset's values, and do nothing else");
}

void add_view_options(CLI::App* verb, Options& o) {
  ReconstructOptions& options = o.request.options;
  verb->add_option("--downscale", options.downscale,
                   "Use the images at 1/N of their size. 0: such that the training views show at most 60 "
                   "million pixels of the object")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  CLI::Option* every =
      verb->add_option(
              "--test-every", options.test_every,
              "Hold out every Nth view for testing when the capture has no test split; 0: train on all views")
          ->capture_default_str();
  verb->add_option("--split", o.split,
                   "The same as a word: every:N, or random:SHARE of the views, chosen by --seed")
      ->excludes(every);
  verb->add_option("--views", options.views,
                   "Train on N views only, spread evenly; the others become validation views. 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void add_fit_options(CLI::App* verb, Options& o) {
  verb->add_option("--poses", o.poses,
                   "Poses of the training cameras. auto: aligned with the object "
                   "where that explains the photographs better. given: as the capture has them")
      ->check(CLI::IsMember({"auto", "given"}))
      ->capture_default_str();
  verb->add_option(
          "--exposures", o.exposures,
          "Exposures of the training photographs. auto: made equal, by channel, where they differ and "
          "that explains the photographs better. given: taken for equal")
      ->check(CLI::IsMember({"auto", "given"}))
      ->capture_default_str();
}

void add_light_options(CLI::App* verb, Options& o) {
  verb->add_option("--light", o.light,
                   "How the light moves against the object. world: not at all. turntable: the object turned "
                   "under fixed lamps. camera: the light is fixed to the camera. auto: the one that explains "
                   "the photographs best")
      ->check(CLI::IsMember({"auto", "world", "camera", "turntable"}))
      ->capture_default_str();
  verb->add_option("--light-color", o.light_color,
                   "Assumption on the light's color. near-white: nearly white, unless highlights show "
                   "otherwise. free: none. R,G,B: its mean color, linear, up to a factor")
      ->capture_default_str();
}

}  // namespace

void add_reconstruct(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("reconstruct", "Make an editable object (a project) from posed photographs");
  verb->add_option("capture", o->capture,
                   "Folder of posed photographs, or its file of cameras; not needed with --resume");
  verb->add_option("-o,--output", o->project, "Project folder to create");
  add_schedule_options(verb, *o);
  add_settings(verb, *o);
  add_view_options(verb, *o);
  add_fit_options(verb, *o);
  add_light_options(verb, *o);
  verb->add_option("--format", o->request.format,
                   capture_format_names() + " (default: detected from the files)");
  verb->add_flag("--strict", o->request.strict, "Refuse a capture of which images are missing");
  CLI::Option* resume = verb->add_flag("--resume", o->request.resume,
                                       "Continue an interrupted reconstruction, with its own options");
  verb->add_flag("--force", o->request.replace, "Replace the project in that folder, including its edits")
      ->excludes(resume);
  commands.on(verb, o, run_reconstruct);
}

}  // namespace cei3d
