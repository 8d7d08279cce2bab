// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/capture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/name_distance.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/photographs.h"
#include "engine/capture/spread.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr Split kSplits[] = {Split::train, Split::val, Split::test};

const CaptureFormat& format_named(const std::string& name) {
  for (const CaptureFormat& f : capture_formats())
    if (f.name == name) return f;
  fail_usage("There is no capture format '{}'. Known: {}.", name, capture_format_names());
}

const CaptureFormat& format_of(const fs::path& path, const std::string& wanted) {
  if (!wanted.empty()) {
    const CaptureFormat& f = format_named(wanted);
    if (!f.detect(path)) fail("{} is not a {} capture ({}).", path.string(), wanted, f.layout);
    return f;
  }
  for (const CaptureFormat& f : capture_formats())
    if (f.detect(path)) return f;
  fail("{} is not a capture of a known format ({}).", path.string(), capture_format_layouts("; "));
}

Vec3d camera_right(const Camera& c) {
  return {c.world_from_cam.row[0].x, c.world_from_cam.row[1].x, c.world_from_cam.row[2].x};
}
Vec3d camera_up(const Camera& c) {
  return -Vec3d{c.world_from_cam.row[0].y, c.world_from_cam.row[1].y, c.world_from_cam.row[2].y};
}

// The coordinate axis nearest to a direction, if the cosine is large enough.
std::optional<Vec3d> near_axis(Vec3d direction, double cosine) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) > cosine) {
      Vec3d up{0, 0, 0};
      up[axis] = direction[axis] > 0 ? 1 : -1;
      return up;
    }
  return std::nullopt;
}

// The direction most perpendicular to the cameras' horizontal axes: cameras are seldom rolled, but often
// tilted, all in the same way if the object was photographed from one side. The smallest eigenvector of A =
// sum of x x^T is the largest of (trace A) I - A: power iteration. near: start, and decides the sign.
Vec3d across_horizontals(const std::vector<Vec3d>& horizontals, Vec3d near) {
  Vec3d up = near;
  for (int k = 0; k < 500; ++k) {
    Vec3d sum{0, 0, 0};
    for (const Vec3d x : horizontals) sum += up - x * dot(x, up);
    up = normalize(sum);
  }
  return dot(up, near) < 0 ? -up : up;
}

// Most photographs are taken upright, so the mean of the cameras' own up axes points up. It is snapped to the
// nearest axis; without a clear mean the format's convention is used. Where the format's world frame is
// arbitrary (often that of the first camera), the estimate is used as it is.
Vec3d up_axis(const Capture& capture) {
  const std::optional<Vec3d> stated = format_named(capture.format).up;
  const Vec3d convention = stated.value_or(Vec3d{0, 0, 1});
  Vec3d sum{0, 0, 0};
  std::vector<Vec3d> horizontals;
  for (const View& v : capture.views) {
    const Vec3d up = camera_up(v.camera), right = camera_right(v.camera);
    if (!std::isfinite(dot(up, up) + dot(right, right))) continue;
    sum += up;
    horizontals.push_back(right);
  }
  const size_t n = horizontals.size();
  if (n < 5 || length(sum) < 0.3 * double(n)) return convention;
  const Vec3d mean = normalize(sum);
  if (stated) return near_axis(mean, 0.9).value_or(convention);
  const Vec3d up = across_horizontals(horizontals, mean);
  return near_axis(up, 0.995).value_or(up);
}

void hold_out(Capture& capture, const CaptureOptions& o) {
  const int every = o.test_every;
  if (every < 0 || every == 1)
    fail_usage("Every Nth view is held out for testing: N should be 2 or more (or 0 for none), not {}.",
               every);
  const bool has_split = std::any_of(capture.views.begin(), capture.views.end(),
                                     [](const View& v) { return v.split != Split::train; });
  if (has_split && o.test_share > 0)
    fail_usage(
        "The capture {} has a split of its own into training and other views; leave the random split out.",
        capture.root.string());
  if (has_split) return;
  if (o.test_share > 0) return hold_out_random(capture, o.test_share, o.seed);
  for (size_t i = 0; every > 0 && i < capture.views.size(); i += size_t(every))
    capture.views[i].split = Split::test;
}

void make_names_unique(Capture& capture) {
  std::set<std::string> taken;
  for (View& view : capture.views) {
    std::string name = view.name;
    if (taken.count(name))
      name = fmt::format("{}/{}", split_name(view.split), fs::path(view.name).filename().string());
    for (int n = 2; taken.count(name); ++n) name = fmt::format("{}-{}", view.name, n);
    taken.insert(view.name = name);
  }
}

std::string normalized(const std::string& name) {
  fs::path path = fs::path(name).lexically_normal();
  if (has_image_suffix(path)) path.replace_extension();
  return path.generic_string();
}

std::string near_names(const Capture& capture, const std::string& name) {
  std::vector<std::pair<size_t, std::string>> all;
  for (const View& v : capture.views)
    all.push_back(
        {std::min(name_distance(name, v.name), name_distance(name, fs::path(v.name).filename().string())),
         v.name});
  const size_t n = std::min<size_t>(3, all.size());
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(n), all.end());
  std::string text;
  for (size_t i = 0; i < n; ++i) text += (i ? ", " : "") + all[i].second;
  return text;
}

std::string shortened(const std::string& text) {
  constexpr size_t kLetters = 100;
  return text.size() <= kLetters ? text : text.substr(0, kLetters) + "...";
}

Capture loaded(const fs::path& path, const CaptureOptions& options) {
  if (!fs::exists(path)) fail("There is no capture at {}; check the path.", path.string());
  const CaptureFormat& format = format_of(path, options.format);
  Capture capture = format.load(path);
  if (capture.views.empty()) fail("{} lists no views.", path.string());
  fit_to_photographs(capture, options.strict);
  hold_out(capture, options);
  keep_training_views(capture, options.views);
  std::stable_sort(capture.views.begin(), capture.views.end(),
                   [](const View& a, const View& b) { return a.split < b.split; });
  make_names_unique(capture);
  const std::optional<Vec3d> stated = format.stated_up ? format.stated_up(path) : std::nullopt;
  capture.up = stated ? *stated : up_axis(capture);
  return capture;
}

}  // namespace

const char* split_name(Split split) {
  return split == Split::train ? "train" : split == Split::val ? "val" : "test";
}

std::optional<Split> split_from_name(const std::string& name) {
  for (const Split split : kSplits)
    if (name == split_name(split)) return split;
  return std::nullopt;
}

std::vector<View> views_of(const Capture& capture, Split split) {
  std::vector<View> views;
  for (const View& v : capture.views)
    if (v.split == split) views.push_back(v);
  return views;
}

std::string capture_format_names() {
  std::string text;
  for (const CaptureFormat& f : capture_formats()) text += (text.empty() ? "" : ", ") + f.name;
  return text;
}

std::string capture_format_programs() {
  std::string text;
  for (const CaptureFormat& f : capture_formats()) text += (text.empty() ? "" : ", ") + f.programs;
  return text;
}

std::string capture_format_layouts(const std::string& separator) {
  std::string text;
  for (const CaptureFormat& f : capture_formats())
    text += (text.empty() ? "" : separator) + f.programs + ": " + f.layout;
  return text;
}

Capture load_capture(const fs::path& path, const CaptureOptions& options) {
  try {
    return loaded(path, options);
  } catch (const fs::filesystem_error& e) {  // names that are longer than any file's
    fail("{} names a file that cannot be looked for: {}. {}", path.string(), e.code().message(),
         shortened(e.path1().string()));
  }
}

bool is_capture(const fs::path& path) {
  try {
    const auto& formats = capture_formats();
    return std::any_of(formats.begin(), formats.end(), [&](const auto& f) { return f.detect(path); });
  } catch (const fs::filesystem_error&) {
    return false;  // a folder that may not be looked into
  } catch (const Error&) {
    return true;  // files that a format looks into and cannot read
  }
}

const View& find_view(const Capture& capture, const std::string& name) {
  const std::string wanted = normalized(name);
  const View* by_stem = nullptr;
  for (const View& v : capture.views) {  // training views come first
    if (v.name == wanted || v.name == name) return v;
    if (!by_stem && fs::path(v.name).filename().generic_string() == wanted) by_stem = &v;
  }
  if (by_stem) return *by_stem;
  fail_usage("The capture has no view '{}'. Near names: {}.", name, near_names(capture, wanted));
}

CaptureSpec parse_capture_spec(const std::string& spec) {
  const size_t colon = spec.rfind(':');
  if (colon == std::string::npos || fs::exists(spec)) return {spec, std::nullopt};
  const std::string word = spec.substr(colon + 1);
  if (const auto split = split_from_name(word)) return {spec.substr(0, colon), split};
  if (fs::exists(spec.substr(0, colon)))
    fail_usage("'{}' is not a split of a capture: use train, val or test.", word);
  return {spec, std::nullopt};
}

}  // namespace cei3d
