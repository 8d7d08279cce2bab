// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "engine/evaluate/evaluation_set.h"

namespace cei3d {
namespace {

struct Options {
  std::string out, time, trial_time, sections, split;
  std::vector<std::string> captures;
  std::string part_view;
  PaintStroke paint;
  EditTruth part_truth;
  std::vector<std::string> positive, negative, set;
  std::string color = "#c04020";
  std::string views = "100,50,25,12", downscales = "1,2,4,8";
  int seeds = 1;
  bool boards = false;
  EvaluationRequest request;
};

constexpr const char* kSections[] = {"paint", "part", "applications", "views", "sizes"};

std::vector<int> counts(const std::string& text, const std::string& option) {
  std::vector<int> out;
  const size_t n = size_t(std::count(text.begin(), text.end(), ',')) + 1;
  for (const double v : parse_numbers(text, n, option)) {
    if (!(v >= 1 && v <= 100000) || v != double(int(v)))
      fail_usage("{} '{}' must be whole numbers of 1 or more.", option, text);
    out.push_back(int(v));
  }
  return out;
}

bool wanted(const Options& o, const std::string& section) {
  return o.sections.empty() || ("," + o.sections + ",").find("," + section + ",") != std::string::npos;
}

void check_sections(const std::string& text) {
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (std::find(std::begin(kSections), std::end(kSections), word) == std::end(kSections))
      fail_usage("--only '{}': unknown section '{}'. Sections are paint, part, applications, views, sizes.",
                 text, word);
    begin = end + 1;
  }
}

void check_truth(const EditTruth& t, const char* which) {
  if (t.pictures.empty() != t.masks.empty())
    fail_usage("--{0}truth and --{0}mask need each other: true images of the edit, and masks of where it is.",
               which);
}

std::optional<PaintStroke> paint_of(const Options& o) {
  if (o.paint.view.empty() != o.paint.scribble.empty()) fail_usage("--view and --scribble need each other.");
  if (!o.request.paint_truth.pictures.empty() && o.paint.view.empty())
    fail_usage("--truth and --mask score a scribble; give --view and --scribble, too.");
  if (o.paint.view.empty()) return std::nullopt;
  return o.paint;
}

std::optional<PartTrial> part_of(const Options& o) {
  if (o.part_view.empty() != o.positive.empty()) fail_usage("--part-view and --positive need each other.");
  if (o.part_view.empty()) return std::nullopt;
  PartTrial t;
  t.command.view = o.part_view;
  t.command.positive = parse_pixels(o.positive, "--positive");
  t.command.negative = parse_pixels(o.negative, "--negative");
  t.command.effects.color = o.color;
  t.command.effects.replace = true;
  t.truth = o.part_truth;
  return t;
}

EvaluationRequest request_of(const Options& o) {
  EvaluationRequest r = o.request;
  check_sections(o.sections);
  check_truth(r.paint_truth, "");
  check_truth(o.part_truth, "part-");
  r.out = o.out;
  if (!o.split.empty()) parse_split(o.split, r.options);
  if (!o.time.empty()) r.options.seconds = parse_duration(o.time);
  r.options.set = settings_from_text(o.set);
  if (!o.trial_time.empty()) r.trial_seconds = parse_duration(o.trial_time);
  r.paint = paint_of(o);
  r.part = part_of(o);
  if (!wanted(o, "part")) r.part.reset();
  if (wanted(o, "views")) r.views = counts(o.views, "--views");
  if (wanted(o, "sizes")) r.downscales = counts(o.downscales, "--downscales");
  r.ablations = wanted(o, "paint");
  r.parts = wanted(o, "part");
  r.applications = wanted(o, "applications");
  return r;
}

// With several captures, objects from fewer or smaller photographs are made only if the user asks for them.
EvaluationSetRequest set_of(const Options& o) {
  EvaluationSetRequest set;
  set.each = request_of(o);
  if (o.captures.size() > 1 && (set.each.paint || set.each.part || !set.each.project.empty()))
    fail_usage(
        "--view, --part-view and --project are about one capture; several bring their own edits/ along.");
  if (o.sections.empty()) set.each.views = set.each.downscales = {};
  for (const std::string& c : o.captures) set.captures.push_back(parse_capture_spec(c).path);
  set.seeds = o.seeds;
  set.boards = o.boards;
  return set;
}

void evaluate_set(const Options& o, Session& session, Console& console) {
  const EvaluationSetReport report = evaluate_captures(session, set_of(o), console);
  for (const EvaluatedCapture& c : report.captures)
    if (!c.failed.empty()) console.warn(fmt::format("{} could not be evaluated: {}", c.name, c.failed));
  console.answer(report.json(),
                 report.markdown() + fmt::format("\nWritten to {}.\n",
                                                 (std::filesystem::path(o.out) / "report.md").string()));
}

void evaluate(const Options& o, Session& session, Console& console) {
  if (o.captures.size() > 1 || o.seeds > 1 || o.boards) return evaluate_set(o, session, console);
  EvaluationRequest request = request_of(o);
  request.capture = parse_capture_spec(o.captures.front()).path;
  const EvaluationReport report = evaluate_capture(session, request, console);
  for (const auto* rows : {&report.views, &report.sizes})
    for (const EvaluationRow& r : *rows)
      if (!r.skipped.empty()) console.warn(fmt::format("Skipped {}: {}.", r.what, r.skipped));
  console.answer(report.json(),
                 report.markdown() + fmt::format("\nWritten to {}.\n",
                                                 (std::filesystem::path(o.out) / "report.md").string()));
}

void add_object(CLI::App* verb, Options& o) {
  ReconstructOptions& options = o.request.options;
  options.test_every = 8;
  verb->add_option("--project", o.request.project,
                   "Existing project of this capture to evaluate (default: reconstruct one)")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--preset", options.preset, "Preset of every reconstruction, see `cei3d reconstruct -h`")
      ->check(CLI::IsMember({"fast", "balanced", "paper"}))
      ->capture_default_str();
  CLI::Option* time = verb->add_option(
      "--time", o.time,
      "Time to reconstruct the object: seconds, or 90s, 10m, 1h30m (default: the preset's number of steps)");
  verb->add_option("--trial-time", o.trial_time,
                   "Time for each object from fewer or smaller photographs (default: --time)");
  verb->add_option("--iterations", options.iterations,
                   "Steps of every geometry stage, instead of --time; 0: the preset's")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->excludes(time);
  verb->add_option("--set", o.set,
                   "key=value: a setting of the preset, see `cei3d reconstruct -h`; repeatable")
      ->expected(1)
      ->take_all();
  verb->add_option("--seed", options.seed, "Random seed")->capture_default_str();
  CLI::Option* every =
      verb->add_option("--test-every", options.test_every,
                       "Hold out every Nth view for testing when the capture has no test split")
          ->capture_default_str();
  verb->add_option("--split", o.split,
                   "The same as a word: every:N, or random:SHARE of the views, chosen by --seed")
      ->excludes(every);
  verb->add_option("--format", o.request.format,
                   "Format of the capture, see `cei3d check -h` (default: detected from the files)");
  verb->add_option("--views", o.views,
                   "Numbers of photographs to try; numbers larger than the capture are skipped")
      ->capture_default_str();
  verb->add_option("--downscales", o.downscales, "Sizes of photographs to try: 1/N")->capture_default_str();
}

void add_edits(CLI::App* verb, Options& o) {
  verb->add_option("--view", o.paint.view, "View of the scribble (default: no paint edit is scored)");
  verb->add_option("--scribble", o.paint.scribble.path, "RGBA PNG to paint, as in `edit paint`")
      ->check(CLI::ExistingFile);
  verb->add_option("--truth", o.request.paint_truth.pictures,
                   "Folder of true images of the painted object, named like the views")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--mask", o.request.paint_truth.masks, "Folder of masks, bright where the paint should be")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--part-view", o.part_view, "View of the clicks on a part");
  verb->add_option("--positive", o.positive, "Clicks on the part, X,Y ...");
  verb->add_option("--negative", o.negative, "Clicks that are not on the part, X,Y ...");
  verb->add_option("--part-color", o.color, "New albedo of the part, '#RRGGBB'")->capture_default_str();
  verb->add_option("--part-truth", o.part_truth.pictures, "Folder of true images of the recolored object")
      ->check(CLI::ExistingDirectory);
  verb->add_option("--part-mask", o.part_truth.masks, "Folder of masks of the part")
      ->check(CLI::ExistingDirectory);
}

}  // namespace

void add_evaluate(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(
      "evaluate",
      "The paper's evaluation of captures: novel views, a paint and a part edit, ablations, fewer and "
      "smaller photographs; a report with images. Can be interrupted and called again");
  verb->add_option(
          "captures", o->captures,
          "Folders of posed photographs, or their .json. Of several, OUTPUT/report.md has the tables of "
          "all; each is edited by what lies in its edits/ folder, or by a scribble that is made up")
      ->required();
  verb->add_option("-o,--output", o->out, "Folder for the report, its images and objects")->required();
  add_object(verb, *o);
  add_edits(verb, *o);
  verb->add_option(
      "--only", o->sections,
      "Sections to run besides the novel views: paint,part,applications,views,sizes (default: all; of "
      "several captures all but views,sizes)");
  verb->add_option("--seeds", o->seeds,
                   "Objects of each capture, of as many seeds; the tables have their spread")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  verb->add_flag("--boards", o->boards,
                 "Also write boards for a user study: the painted object by each method, in an order that "
                 "boards/key.json tells");
  add_samples(verb, o->request.samples);
  add_networks(verb, o->request.networks);
  commands.on(verb, o, evaluate);
}

}  // namespace cei3d
