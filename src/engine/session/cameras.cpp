// SPDX-License-Identifier: Apache-2.0
#include "engine/session/cameras.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/json_reader.h"
#include "core/base/parse_json.h"
#include "core/math/quantile.h"
#include "core/math/tangents.h"
#include "engine/project/dataset.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// `camera` moved to `center` and turned towards `target`.
Camera look_at(Camera camera, Vec3d center, Vec3d target, Vec3d up) {
  camera.center = center;
  camera.world_from_cam = upright_rotation(target - center, up);
  return camera;
}

std::vector<NamedCamera> named(const std::vector<View>& views) {
  std::vector<NamedCamera> cameras;
  for (const View& v : views) cameras.push_back({v.name, "", v.camera});
  return cameras;
}

// "train, test": the splits that have views.
std::string split_names(const Capture& capture) {
  std::string text;
  for (const Split split : {Split::train, Split::val, Split::test})
    if (!views_of(capture, split).empty())
      text += (text.empty() ? "" : ", ") + std::string(split_name(split));
  return text.empty() ? "none" : text;
}

std::vector<NamedCamera> read_camera_file(const fs::path& path) {
  std::vector<NamedCamera> cameras;
  try {
    const std::string text = read_file(path);
    if (nested_too_deep(text)) fail("{} is nested too deep to be a list of cameras.", path.string());
    const Json json = Json::parse(text);
    JsonReader file(json, path.string());
    for (const char* key : {"program", "project", "edits", "light", "channels", "switches", "depth", "axes"})
      file.has(key);  // what else a render.json has
    for (const Json& j : file.array("cameras")) {
      JsonReader camera(j, "A camera in " + path.string());
      cameras.push_back({camera.require<std::string>("name"), "", camera_from_json(camera)});
      camera.has("file");  // the image that was rendered
      camera.finish();
    }
    file.finish();
  } catch (const Json::exception& e) {
    fail("{} is not a list of cameras ({}); a render.json of `cei3d render` is one.", path.string(),
         e.what());
  }
  for (const NamedCamera& c : cameras)
    check_camera(c.camera, fmt::format("{}: camera {}", path.string(), c.name));
  return cameras;
}

void set_files(std::vector<NamedCamera>& cameras) {
  std::map<std::string, int> count;
  const auto stem = [](const std::string& name) { return fs::path(name).filename().string(); };
  for (const NamedCamera& c : cameras) ++count[stem(c.name)];
  for (NamedCamera& c : cameras) {
    // Names may come from files: they never lead out of the output folder.
    const fs::path name = fs::path(c.name).lexically_normal();
    if (c.name.empty() || name.is_absolute() || *name.begin() == "..")
      fail("'{}' is not a usable view name.", c.name);
    c.file = count[stem(c.name)] == 1 ? stem(c.name) : name.generic_string();
  }
}

}  // namespace

void check_camera(const Camera& c, const std::string& what) {
  constexpr int kMaxPixels = 1 << 16;
  if (c.width < 1 || c.height < 1 || !(c.fx > 0) || !(c.fy > 0))
    fail("{} has no size or no focal length.", what);
  if (c.width > kMaxPixels || c.height > kMaxPixels)
    fail("{} is {}x{} pixels, which is too large.", what, c.width, c.height);
  double sum = c.fx + c.fy + c.cx + c.cy + c.skew + c.center.x + c.center.y + c.center.z;
  const Mat3d product = c.world_from_cam * transpose(c.world_from_cam);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += std::abs(product.row[i][j] - double(i == j)) < 1e-3 ? 0 : NAN;
  if (!std::isfinite(sum)) fail("{} has numbers that are not finite, or a rotation that is none.", what);
}

Camera read_camera(const fs::path& path) {
  const std::vector<NamedCamera> cameras = read_camera_file(path);
  if (cameras.size() != 1)
    fail_usage("{} has {} cameras; a view of its own is a file with one.", path.string(), cameras.size());
  return cameras[0].camera;
}

bool shows_photographs(const CameraChoice& choice) {
  return std::holds_alternative<ProjectViews>(choice) || std::holds_alternative<CaptureViews>(choice);
}

// The capture of this path; what was found out about its views, if it is that of the project.
Capture named_capture(const Project& project, const Capture& own, const fs::path& path) {
  Capture capture = load_capture(path);
  if (capture.format != own.format) return capture;
  Capture as_read = load_capture(path, reading_of(project));
  if (capture_fingerprint(as_read) != project.fingerprint()) return capture;
  as_read = with_cameras(std::move(as_read), project.refined_cameras());
  std::map<std::string, fs::path> doubtful;
  for (const View& v : own.views) doubtful[v.name] = v.doubtful_path;
  for (View& v : as_read.views) v.doubtful_path = doubtful[v.name];
  return as_read;
}

bool is_camera_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  const Json j = parse_json(read_file(path));
  return j.is_object() && j.contains("cameras");
}

CaptureOptions reading_of(const Project& project) {
  JsonReader reader(project.head().options, "The options of the reconstruction");
  CaptureOptions o;
  o.format = reader.optional("format", o.format);
  o.test_every = reader.optional("test_every", o.test_every);
  o.views = reader.optional("views", o.views);
  o.test_share = reader.optional("test_share", o.test_share);
  o.seed = reader.optional("seed", o.seed);
  return o;
}

std::vector<View> choose_views(const Project& project, const fs::path& path, std::optional<Split> split) {
  const Capture own = project.capture();
  Capture capture = path.empty() ? own : named_capture(project, own, path);
  std::map<std::string, Split> known;
  for (const View& v : own.views) known[v.name] = v.split;
  const bool has_splits = std::any_of(capture.views.begin(), capture.views.end(),
                                      [](const View& v) { return v.split != Split::train; });
  if (!has_splits)
    for (View& v : capture.views)
      if (const auto it = known.find(v.name); it != known.end()) v.split = it->second;
  const std::vector<View> views = split ? views_of(capture, *split) : capture.views;
  if (views.empty())
    fail("{} has no {} views; it has {}.", path.empty() ? project.capture().root.string() : path.string(),
         split ? split_name(*split) : "such", split_names(capture));
  return views;
}

Camera resized(Camera c, int width, int height) {
  const double sx = double(width) / c.width;
  c.cx = c.cx * sx;
  c.cy = (c.cy - c.height / 2.0) * sx +
         height / 2.0;  // square pixels stay square: the center of the image stays
  c.fx *= sx;
  c.fy *= sx;
  c.skew *= sx;
  c.width = width;
  c.height = height;
  return c;
}

std::vector<NamedCamera> turntable(const Capture& capture, const Normalization& n, int frames) {
  const Vec3d up = normalize(capture.up);
  std::vector<double> distances, heights;
  for (const View& v : capture.views) {
    const Vec3d d = v.camera.center - n.center;
    distances.push_back(length(d));
    heights.push_back(dot(d, up) / std::max(length(d), 1e-12));
  }
  const double distance = median(distances);
  const double height = clamp(median(heights), -0.9, 0.9), radius = std::sqrt(1 - height * height);
  const Tangents<double> level = tangents_of(up);
  std::vector<NamedCamera> cameras;
  for (int i = 0; i < frames; ++i) {
    const double a = 2 * M_PI * i / frames;
    const Vec3d direction = -(level.x * std::cos(a) + level.y * std::sin(a)) * radius + up * height;
    Camera c = look_at(capture.views.front().camera, n.center + direction * distance, n.center, up);
    c.cx = c.width / 2.0;
    c.cy = c.height / 2.0;
    cameras.push_back({fmt::format("turn_{:03}", i), "", c});
  }
  return cameras;
}

std::vector<NamedCamera> choose_cameras(const Project& project, const CameraChoice& choice, int width,
                                        int height) {
  const auto own = [&] {
    const std::vector<View> test = views_of(project.capture(), Split::test);
    return named(test.empty() ? project.capture().views : test);
  };
  std::vector<NamedCamera> cameras;
  if (const auto* c = std::get_if<CaptureViews>(&choice))
    cameras = named(choose_views(project, c->path, c->split));
  else if (const auto* f = std::get_if<CameraFile>(&choice))
    cameras = read_camera_file(f->path);
  else if (const auto* t = std::get_if<Turntable>(&choice))
    cameras = turntable(project.capture(), project.head().normalization, t->frames);
  else
    cameras = own();
  if (cameras.empty()) fail("There are no cameras to render.");
  set_files(cameras);
  if (width > 0)
    for (NamedCamera& c : cameras) c.camera = resized(c.camera, width, height);
  return cameras;
}

}  // namespace cei3d
