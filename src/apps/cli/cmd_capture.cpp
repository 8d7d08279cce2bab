// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "engine/photos/capture_photos.h"

namespace cei3d {
namespace {

struct Options {
  std::vector<std::string> clicks, negative;
  double focal = 0;
  bool no_masks = false;
  PhotosRequest request;
};

// "IMG_0012.jpg:1200,840".
PhotosRequest::Click parse_click(const std::string& text, bool object) {
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0)
    fail_usage("A click is PHOTOGRAPH:X,Y, for example IMG_0012.jpg:1200,840, not '{}'.", text);
  const std::vector<double> at = parse_numbers(text.substr(colon + 1), 2, "--click");
  return {text.substr(0, colon), {at[0], at[1]}, object};
}

PhotosRequest request_of(const Options& o) {
  PhotosRequest r = o.request;
  for (const std::string& c : o.clicks) r.clicks.push_back(parse_click(c, true));
  for (const std::string& c : o.negative) r.clicks.push_back(parse_click(c, false));
  if (o.clicks.empty() && !o.negative.empty()) fail_usage("--negative-click needs a --click on the object.");
  if (o.focal > 0) r.focal = o.focal;
  r.masks = !o.no_masks;
  return r;
}

std::string list_of(const std::string& what, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  std::string text = what;
  for (const std::string& n : names) text += (text == what ? " " : ", ") + n;
  return text + ".\n";
}

std::string text_of(const PhotosReport& r, const PhotosRequest& request) {
  std::string text = fmt::format("{}: poses of {} of {} photographs in {}.\n", r.out.string(), r.posed,
                                 r.photos, duration_text(r.seconds));
  text += list_of("Without a pose, left out:", r.without_pose);
  text += list_of("Without a mask, because the object was not found:", r.without_mask);
  if (!request.masks) return text + "The masks are yours to add, in masks/ beside images/.";
  text += fmt::format(
      "{}: all masks; those of which `cei3d check` says that something is wrong have a red frame.\n",
      (r.out / "contact_sheet.png").string());
  return text + fmt::format("Next: cei3d reconstruct {} -o PROJECT{}", r.out.string(),
                            request.turntable ? " --light turntable" : "");
}

void capture(const Options& o, Session& session, Console& console) {
  const PhotosRequest request = request_of(o);
  const PhotosReport r = capture_photos(request, console);
  Json json = r.json();
  if (request.masks) {
    CheckRequest check;
    check.capture = r.out;
    check.contact_sheet = r.out / "contact_sheet.png";
    const CheckReport checked = session.check(check);
    json["check"] = checked.json();
    for (const Finding& f : checked.report.findings)
      if (f.severity != Severity::note) console.warn(f.what + " " + f.fix);
  }
  console.done(json, text_of(r, request));
}

void add_mask_options(CLI::App* verb, Options& o) {
  verb->add_option("--click", o.clicks,
                   "PHOTOGRAPH:X,Y ...: pixels of the object, of one photograph or several. Without clicks "
                   "the object is what stands in the middle of what the photographs show");
  verb->add_option("--negative-click", o.negative, "PHOTOGRAPH:X,Y ...: pixels that are not of the object");
  verb->add_option(
          "--background", o.request.plate,
          "A photograph without the object, from the same place: the object is what differs from it. "
          "For a camera that stood still")
      ->check(CLI::ExistingFile);
  verb->add_flag("--no-masks", o.no_masks, "Find poses only");
}

}  // namespace

void add_capture(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(
      "capture",
      "Make a capture of bare photographs or a video: poses by COLMAP, masks of the object. Can be "
      "interrupted and called again");
  verb->add_option("photos", o->request.photos, "Folder of photographs (JPEG, PNG, TIFF, HEIC), or a video")
      ->required();
  verb->add_option("-o,--output", o->request.out, "Folder for the capture")->required();
  verb->add_flag(
      "--turntable", o->request.turntable,
      "The object turned before a camera that stood still. Else that is tried if few poses are found");
  verb->add_option("--focal", o->focal,
                   "Focal length of the photographs in pixels (default: by their EXIF notes, else guessed)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--frames", o->request.frames, "Images to take of a video")
      ->check(CLI::Range(8, 1000))
      ->capture_default_str();
  add_mask_options(verb, *o);
  const CommonOptions& common = commands.common();
  commands.on(verb, o, [&common](Options& options, Session& session, Console& console) {
    options.request.threads = common.threads;
    capture(options, session, console);
  });
}

}  // namespace cei3d
