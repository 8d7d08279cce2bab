// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "core/base/error.h"
#include "engine/capture/capture.h"
#include "engine/capture/coverage.h"

namespace cei3d {
namespace {

struct Options {
  std::string capture;
  std::filesystem::path output;
  bool fix = false;
  CheckRequest request;
};

std::string split_text(const SplitReport& s) {
  return fmt::format(
      "{:<12}{} views of {} x {}{}; the object covers {:.0f} % of an image ({:.0f} to {:.0f})\n",
      split_name(s.split), s.views, s.size.width, s.size.height, s.sizes_vary ? " and other sizes" : "",
      100 * s.coverage, 100 * s.coverage_min, 100 * s.coverage_max);
}

std::string finding_text(const Finding& f) {
  const char* word = f.severity == Severity::error     ? "problem"
                     : f.severity == Severity::warning ? "warning"
                                                       : "note";
  return fmt::format("{}: {} {}\n", word, f.what, f.fix);
}

std::string report_text(const CheckReport& checked) {
  const CaptureReport& r = checked.report;
  std::string text = fmt::format("format      {}\n", r.format);
  for (const SplitReport& s : r.splits) text += split_text(s);
  text += fmt::format("up          ({:g}, {:g}, {:g})\n", r.up.x, r.up.y, r.up.z);
  if (r.normalization) {
    const Vec3d c = r.normalization->center;
    text += fmt::format("object      radius {:.4g} about ({:.4g}, {:.4g}, {:.4g})\n", checked.object_radius,
                        c.x, c.y, c.z);
    text += fmt::format("cameras     {:.4g} away ({:.4g} to {:.4g})\n", r.distance, r.distance_min,
                        r.distance_max);
    const SeenSides seen = seen_sides(checked.capture, c);
    text += fmt::format(
        "seen        {:.0f} % of all directions are within {} degrees of a camera; the widest gap is around "
        "({:.2f}, {:.2f}, {:.2f}), {:.0f} degrees from the nearest\n",
        100 * seen.share, kSeenWithin, seen.unseen.x, seen.unseen.y, seen.unseen.z, seen.gap);
  }
  for (const std::string& what : checked.repaired) text += fmt::format("repaired: {}\n", what);
  for (const Finding& f : r.findings) text += finding_text(f);
  return text + (r.usable() ? "Ready for `cei3d reconstruct`.\n" : "");
}

void run_check(const Options& o, Session& session, Console& console) {
  CheckRequest request = o.request;
  request.capture = parse_capture_spec(o.capture).path;
  if (o.fix && o.output.empty()) fail_usage("--fix needs -o FOLDER for the corrected capture.");
  (o.fix ? request.fixed : request.picture) = o.output;
  const CheckReport r = session.check(request);
  console.answer(r.json(), report_text(r));
  if (!r.report.usable())
    throw Error(ErrorCode::failed, o.capture + " cannot be used yet.",
                "The problems listed above say what to do.");
}

}  // namespace

void add_check(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(
      "check",
      "Load a capture as `reconstruct` does; report what it contains, and every problem with its fix");
  verb->add_option("capture", o->capture, "Folder of posed photographs, or its file of cameras")->required();
  verb->add_option("--format", o->request.options.format,
                   capture_format_names() + " (default: detected from the files)");
  verb->add_flag("--strict", o->request.options.strict, "Refuse a capture of which images are missing");
  verb->add_option("--test-every", o->request.options.test_every,
                   "Hold out every Nth view for testing when the capture has no test split; 0: none")
      ->capture_default_str();
  verb->add_option(
      "-o,--output", o->output,
      "FILE.html: a page of everything found, with all views. FILE.png: the cameras and the object's "
      "bounding sphere. With --fix the folder of the corrected capture");
  verb->add_flag("--fix", o->fix, "Write a capture without what can be corrected safely, and check that");
  verb->add_option("--contact-sheet", o->request.contact_sheet,
                   "PNG file to write: all views; those of which something is wrong have a red frame");
  commands.on(verb, o, run_check);
}

}  // namespace cei3d
