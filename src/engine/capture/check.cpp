// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/coverage.h"
#include "engine/capture/doctor.h"
#include "engine/capture/normalize.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

// Problems of a single view, in the order of reporting.
enum Problem { kNoFile, kBroken, kBadPose, kEmptyMask, kNoMask, kFullMask, kCut, kAway, kProfile, kProblems };

struct ProblemText {
  Severity severity;
  const char *what, *fix;
};
constexpr std::array<ProblemText, kProblems> kTexts{{
    {Severity::error, "images are missing",
     "Copy them to where the cameras say they are, or remove these views from the camera file."},
    {Severity::error, "images or masks cannot be used", "Copy or render them again."},
    {Severity::error, "poses are not a rotation and a finite position",
     "Estimate the poses again, or remove these views."},
    {Severity::error, "masks are empty", "Remove these views, or correct their masks or alpha."},
    {Severity::error, "images have neither an alpha channel nor a mask file",
     "Add mask files, or save PNGs with alpha."},
    {Severity::error, "masks cover the whole image",
     "Check that the masks mean the object: bright or opaque is object."},
    {Severity::warning, "views show the object cut by the frame border",
     "Step back or widen the frame; what is never seen whole is guessed."},
    {Severity::warning, "cameras look away from the object", "Check the poses of these views."},
    {Severity::warning, "images have a color profile that is damaged or not of RGB, and are taken for sRGB",
     "Convert them to sRGB in a program that shows their colors as they should be."},
}};

struct ViewResult {
  std::array<bool, kProblems> has{};
  std::string detail;  // sentence about a broken file
  ImageSize size;
  double coverage = 0;
  Mask mask;
  PhotoLook look;
  MaskBorder border;
};

bool pose_is_sound(const Camera& c) {
  const Mat3d& r = c.world_from_cam;
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(dot(r.row[i], r.row[j]) - (i == j)));
  const double det = dot(r.row[0], cross(r.row[1], r.row[2]));
  return std::isfinite(dot(c.center, c.center)) && std::isfinite(det) && worst < 2e-3 && det > 0;
}

// Object pixels at the border of the image, or beside what it does not show.
int border_pixels(const Mask& m) {
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= m.width || y >= m.height ? kUnknown : m.object[size_t(y) * m.width + x];
  };
  int n = 0;
  for (int y = 0; y < m.height; ++y)
    for (int x = 0; x < m.width; ++x)
      n += at(x, y) == kObject && (at(x - 1, y) == kUnknown || at(x + 1, y) == kUnknown ||
                                   at(x, y - 1) == kUnknown || at(x, y + 1) == kUnknown);
  return n;
}

void look_at_image(const View& view, ViewResult& out) {
  out.mask = load_mask(view);
  {
    const Image rgba = load_linear_rgba(view);  // decodes the whole file and rejects NaN
    out.look = look_at_photo(view, rgba);
    out.border = look_at_border(view, rgba, out.mask.object);
  }
  out.has[kProfile] = has_unusable_profile(view.image_path);
  const auto& object = out.mask.object;
  const bool full = std::count(object.begin(), object.end(), kBackground) == 0;
  const size_t set = size_t(std::count(out.mask.object.begin(), out.mask.object.end(), kObject));
  out.size = {out.mask.width, out.mask.height};
  out.coverage = double(set) / (double(view.file_camera().width) * view.file_camera().height);
  out.has[kNoMask] = !out.mask.stated;
  out.has[kEmptyMask] = out.mask.stated && set == 0;
  out.has[kFullMask] = out.mask.stated && full;
  out.has[kCut] = out.mask.stated && !full && border_pixels(out.mask) >= 2;
}

ViewResult check_view(const View& view) {
  ViewResult out;
  out.has[kBadPose] = !pose_is_sound(view.camera);
  const bool camera_only = view.image_path.empty() && view.split != Split::train;
  out.has[kNoFile] = (view.image_path.empty() && !camera_only) ||
                     (!view.image_path.empty() && !std::filesystem::exists(view.image_path)) ||
                     (!view.mask_path.empty() && !std::filesystem::exists(view.mask_path));
  if (out.has[kNoFile] || camera_only) return out;
  try {
    look_at_image(view, out);
  } catch (const Error& e) {
    out.has[kBroken] = true;
    out.detail = e.what();
  }
  return out;
}

bool looks_away(const Camera& c, const Normalization& n) {
  const Vec3d p = c.project(n.center);
  const double margin =
      kObjectRadius / n.scale / std::max(p.z, 1e-12) * c.fx;  // the object's radius in pixels
  return p.z <= 0 || p.x < -margin || p.y < -margin || p.x > c.width + margin || p.y > c.height + margin;
}

struct Checked {
  const View* view;
  ViewResult result;
};

// Views that cannot be used at all are left out; what remains is checked again.
bool makes_useless(Problem problem) {
  return problem == kNoFile || problem == kBroken || problem == kBadPose || problem == kEmptyMask ||
         problem == kAway;
}

void report_problems(const std::vector<Checked>& all, CaptureReport& report) {
  for (int problem = 0; problem < kProblems; ++problem) {
    std::vector<std::string> names;
    std::string detail;
    for (const Checked& c : all) {
      if (!c.result.has[problem]) continue;
      if (problem == kBroken && detail.empty()) detail = " First: " + c.result.detail;
      names.push_back(c.view->name);
    }
    if (names.empty()) continue;
    const ProblemText& text = kTexts[problem];
    report.findings.push_back(
        {text.severity,
         fmt::format("{} of {} {}: {}.{}", names.size(), all.size(), text.what, some_names(names), detail),
         text.fix, names, makes_useless(Problem(problem)) ? removal_of(names) : nullptr, problem != kCut});
  }
}

ImageSize file_size(const View& view) {
  const Camera& c = view.file_camera();
  return {c.width, c.height};
}

void report_splits(const std::vector<Checked>& all, CaptureReport& report) {
  for (const Split split : {Split::train, Split::val, Split::test}) {
    SplitReport s{split, 0, {}, false, 0, 1, 0};
    int with_mask = 0;
    for (const auto& [view, result] : all) {
      if (view->split != split) continue;
      ++s.views;
      if (s.size.width == 0) s.size = file_size(*view);
      s.sizes_vary |= !(s.size == file_size(*view));
      if (result.mask.object.empty()) continue;
      ++with_mask;
      s.coverage += result.coverage;
      s.coverage_min = std::min(s.coverage_min, result.coverage);
      s.coverage_max = std::max(s.coverage_max, result.coverage);
    }
    if (with_mask > 0)
      s.coverage /= with_mask;
    else
      s.coverage_min = 0;
    if (s.views > 0) report.splits.push_back(s);
  }
}

void report_normalization(const std::vector<Checked>& all, const std::optional<ObjectBall>& region,
                          CaptureReport& report) {
  std::vector<HullMask> masks;
  for (const auto& [view, result] : all)
    if (view->split == Split::train && result.mask.stated && !result.mask.object.empty() &&
        !result.has[kBadPose])
      masks.push_back({view->camera, result.mask.object});
  if (masks.size() < 2) return;  // already reported as findings of the views
  std::vector<std::string> warnings;
  try {
    report.normalization = normalization_from_masks(masks, &warnings, region);
  } catch (const Error& e) {
    report.findings.push_back({Severity::error, e.what(), ""});
  }
  for (const std::string& w : warnings) report.findings.push_back({Severity::warning, w, ""});
}

void report_distances(const Capture& capture, CaptureReport& report) {
  int n = 0;
  report.distance_min = 1e300;
  for (const View& v : capture.views) {
    if (v.split != Split::train) continue;
    const double d = length(v.camera.center - report.normalization->center);
    if (!std::isfinite(d)) continue;
    report.distance_min = std::min(report.distance_min, d);
    report.distance_max = std::max(report.distance_max, d);
    report.distance += d;
    ++n;
  }
  if (n > 0) report.distance /= n;
  if (n > 0 && report.distance_min < kObjectRadius / report.normalization->scale)
    report.findings.push_back({Severity::warning, "Some cameras are inside the object's bounding sphere.",
                               "Check the poses, or photograph from farther away."});
}

// Alpha that means the background. Mask files are read the right way round by the loader.
void check_polarity(const std::vector<Checked>& all, CaptureReport& report) {
  size_t stated = 0, inside_out = 0;
  for (const auto& [view, result] : all) {
    if (result.mask.object.empty() || !result.mask.stated) continue;
    ++stated;
    const int around = 2 * (result.mask.width + result.mask.height);
    inside_out += border_pixels(result.mask) > 0.8 * around && !result.has[kFullMask];
  }
  if (stated < 2 || double(inside_out) < 0.8 * double(stated)) return;
  report.findings.push_back(
      {Severity::error,
       fmt::format("The masks cover the borders of {} of {} images: they seem to mean the background, not "
                   "the object.",
                   inside_out, stated),
       "Invert them; `check` can write a corrected copy of the capture.",
       {},
       [](Capture& c) {
         for (View& v : c.views) v.dark_object = !v.dark_object;
       }});
}

// Masks with the pixels that were found to be unsure.
class DoubtedMasks {
 public:
  explicit DoubtedMasks(std::vector<JudgedMask> masks)
      : masks_(std::move(masks)), unsure_(masks_.size()), known_(masks_.size()) {}

  std::span<const JudgedMask> masks() const { return masks_; }
  void add_moved(const std::vector<Area>& areas) {
    for (size_t i = 0; i < areas.size(); ++i) {
      add(i, areas[i]);
      masks_[i].moved = !areas[i].empty();
    }
  }
  // Makes the pixels unknown. area: [height][width] of the view; empty: none of them.
  void add(size_t i, const Area& area) {
    if (area.empty()) return;
    if (unsure_[i].empty()) known_[i].assign(masks_[i].mask.begin(), masks_[i].mask.end());
    unsure_[i].resize(area.size());
    for (size_t k = 0; k < area.size(); ++k)
      if (area[k]) unsure_[i][k] = 1, known_[i][k] = kUnknown;
    masks_[i].mask = known_[i];
  }
  // The pixels of the views that have any.
  std::vector<CaptureReport::Doubt> doubts() const {
    std::vector<CaptureReport::Doubt> out;
    for (size_t i = 0; i < masks_.size(); ++i)
      if (!unsure_[i].empty()) out.push_back({masks_[i].view->name, unsure_[i]});
    return out;
  }

 private:
  std::vector<JudgedMask> masks_;
  std::vector<Area> unsure_;
  std::vector<std::vector<uint8_t>> known_;
};

// Where the masks contradict each other. What one reason explains is not held against a mask for another.
void doubt_masks(std::vector<JudgedMask> judged, CaptureReport& report) {
  DoubtedMasks masks(std::move(judged));
  const auto add = [&](const std::vector<Area>& areas) {
    for (size_t i = 0; i < areas.size(); ++i) masks.add(i, areas[i]);
  };
  if (report.normalization)
    masks.add_moved(check_moves(masks.masks(), *report.normalization, report.findings));
  add(check_silhouettes(masks.masks(), report.normalization, report.findings));
  if (report.normalization) add(check_gaps(masks.masks(), *report.normalization, report.findings));
  add(check_borders(masks.masks(), report.findings));
  report.doubts = masks.doubts();
}

void diagnose(const Capture& capture, const std::vector<Checked>& all, CaptureReport& report) {
  check_polarity(all, report);
  check_intrinsics(capture, report.findings);
  check_tracks(capture, report.findings);
  std::vector<JudgedMask> masks;
  std::vector<JudgedPhoto> photos;
  for (const auto& [view, result] : all) {
    if (result.mask.object.empty() || result.has[kBadPose] || !result.mask.stated || result.has[kEmptyMask])
      continue;
    masks.push_back({view, result.mask.object, &result.look.small, &result.border});
    photos.push_back({view, &result.look});
  }
  // Where most views show only a part of the object, what the others see of it does not say what a mask
  // should hold.
  const auto cut = [](const Checked& c) { return c.result.has[kCut]; };
  if (report.normalization && 2 * size_t(std::count_if(all.begin(), all.end(), cut)) > all.size())
    masks.clear();
  doubt_masks(masks, report);
  if (report.normalization) check_photographs(photos, report.normalization->center, report.findings);
}

void report_counts(const Capture& capture, CaptureReport& report) {
  const size_t train = views_of(capture, Split::train).size();
  if (train < 3)
    report.findings.push_back({Severity::error, fmt::format("There are only {} training views.", train),
                               "Take at least 20 photographs from all around; 50 to 100 are good."});
  else if (train < 20)
    report.findings.push_back({Severity::warning, fmt::format("There are only {} training views.", train),
                               "Expect gaps in shape and light; 50 to 100 views are good."});
  if (views_of(capture, Split::test).empty() && views_of(capture, Split::val).empty())
    report.findings.push_back({Severity::note, "There is no test split, so quality cannot be measured.",
                               "Hold every 8th view out (test every)."});
}

}  // namespace

std::string some_names(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size() && i < 5; ++i) text += (i ? ", " : "") + names[i];
  return names.size() > 5 ? fmt::format("{} and {} more", text, names.size() - 5) : text;
}

std::function<void(Capture&)> removal_of(std::vector<std::string> names) {
  return [names = std::move(names)](Capture& c) {
    std::erase_if(
        c.views, [&](const View& v) { return std::find(names.begin(), names.end(), v.name) != names.end(); });
  };
}

bool CaptureReport::usable() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& f) { return f.severity == Severity::error; });
}

CaptureReport check(const Capture& capture, std::optional<Split> only) {
  std::vector<Checked> all;
  for (const View& v : capture.views)
    if (!only || v.split == *only) all.push_back({&v, {}});
  parallel_for(int(all.size()), [&](int i) { all[i].result = check_view(*all[i].view); });

  CaptureReport report;
  report.format = capture.format;
  report.up = capture.up;
  report_splits(all, report);
  report_normalization(all, capture.region, report);
  if (report.normalization) {
    for (Checked& c : all)
      c.result.has[kAway] = !c.result.has[kBadPose] && looks_away(c.view->camera, *report.normalization);
    report_distances(capture, report);
  }
  report_problems(all, report);
  diagnose(capture, all, report);
  if (report.normalization) check_coverage(capture, report.normalization->center, report.findings);
  report_counts(capture, report);
  for (const std::string& w : capture.warnings) report.findings.push_back({Severity::warning, w, ""});
  std::stable_sort(report.findings.begin(), report.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
  return report;
}

void require_usable(const CaptureReport& report) {
  std::string text;
  int n = 0;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error && ++n <= 4)
      text += (text.empty() ? "" : " ") + f.what + (f.fix.empty() ? "" : " " + f.fix);
  if (n > 4) text += fmt::format(" And {} more problems; `cei3d check` lists them.", n - 4);
  if (n > 0) fail("The capture cannot be used. {}", text);
}

void require_usable(const Capture& capture) { require_usable(check(capture, Split::train)); }

}  // namespace cei3d
