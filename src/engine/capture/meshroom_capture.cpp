// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/photograph_index.h"
#include "engine/capture/words.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

fs::path sfm_of(const fs::path& path) {
  if (fs::is_regular_file(path))
    return path.extension() == ".sfm" || path.filename() == "sfm.json" ? path : fs::path();
  for (const char* name : {"cameras.sfm", "sfm.json", "sfmData.json"})
    if (fs::exists(path / name)) return path / name;
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error))
    if (entry.path().extension() == ".sfm") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files.empty() ? fs::path() : files[0];
}

// Numbers are stored as texts by most versions.
double number_in(const Json& j, const std::string& where) {
  double value = 0;
  if (j.is_string())
    value = Words(j.get_ref<const std::string&>(), where).number();
  else
    value = number_of(j, where);
  if (!std::isfinite(value)) fail("{} holds a number that is not finite.", where);
  return value;
}
double number_in(const Json& j, const char* key, const std::string& where) {
  if (!j.contains(key)) fail("{} lacks '{}'.", where, key);
  return number_in(j[key], fmt::format("'{}' of {}", key, where));
}

std::vector<double> numbers_in(const Json& j, const char* key, size_t count, const std::string& where) {
  if (!j.contains(key) || !j[key].is_array() || (count > 0 && j[key].size() != count))
    fail("{} should have {} numbers as '{}'.", where, count, key);
  std::vector<double> out;
  for (const Json& v : j[key]) out.push_back(number_in(v, fmt::format("'{}' of {}", key, where)));
  return out;
}

std::string text_in(const Json& j, const char* key) {
  if (!j.contains(key)) return "";
  return j[key].is_string() ? j[key].get<std::string>() : j[key].dump();
}

// The version as 100 major + minor; before 1.2 principal points were absolute.
int version_of(const Json& file) {
  if (!file.contains("version") || !file["version"].is_array() || file["version"].size() < 2) return 100;
  const auto part = [&](size_t i) { return int(number_in(file["version"][i], "The version of the file")); };
  return 100 * part(0) + part(1);
}

LensDistortion read_lens(const Json& j, const std::string& where) {
  std::string type = text_in(j, "distortionType");
  if (type.empty()) type = text_in(j, "type");
  const std::vector<double> k =
      j.contains("distortionParams") ? numbers_in(j, "distortionParams", 0, where) : std::vector<double>();
  LensDistortion lens;
  if (std::all_of(k.begin(), k.end(), [](double v) { return v == 0; }) &&
      type.find("fisheye") == std::string::npos)
    return lens;
  const auto is = [&](const char* a, const char* b, size_t n) {
    return (type == a || type == b) && k.size() == n;
  };
  if (is("radial1", "radialk1", 1) || is("radial3", "radialk3", 3)) {
    std::copy(k.begin(), k.end(), lens.radial.begin());
  } else if (is("brown", "brown", 5)) {
    std::copy(k.begin(), k.begin() + 3, lens.radial.begin());
    lens.p1 = k[3], lens.p2 = k[4];
  } else if (is("fisheye", "fisheye4", 4)) {
    lens.kind = LensKind::fisheye;
    std::copy(k.begin(), k.end(), lens.radial.begin());
  } else {
    fail("{} has the lens '{}' with {} terms, which is not supported. Export undistorted photographs.", where,
         type, k.size());
  }
  return lens;
}

struct Intrinsics {
  Camera k;
  LensDistortion lens;
};

Intrinsics read_intrinsics(const Json& j, int version, const std::string& where) {
  Intrinsics out;
  const double width = number_in(j, "width", where), height = number_in(j, "height", where);
  if (!(width >= 1 && width <= 65535 && height >= 1 && height <= 65535))
    fail("{} gives an impossible image size.", where);
  out.k.width = int(width), out.k.height = int(height);
  if (j.contains("pxFocalLength"))
    out.k.fx = j["pxFocalLength"].is_array() ? numbers_in(j, "pxFocalLength", 2, where)[0]
                                             : number_in(j, "pxFocalLength", where);
  else
    out.k.fx = number_in(j, "focalLength", where) / number_in(j, "sensorWidth", where) * width;
  out.k.fy = out.k.fx * (j.contains("pixelRatio") ? number_in(j, "pixelRatio", where) : 1);
  if (!(out.k.fx > 0 && out.k.fy > 0)) fail("{} has a focal length that is not positive.", where);
  const std::vector<double> c = numbers_in(j, "principalPoint", 2, where);
  const bool offset = version >= 102;
  out.k.cx = c[0] + (offset ? width / 2 : 0), out.k.cy = c[1] + (offset ? height / 2 : 0);
  out.lens = read_lens(j, where);
  return out;
}

// World-to-camera by columns, which is camera-to-world by rows.
void set_pose(Camera& c, const Json& j, const std::string& where) {
  if (!j.contains("pose") || !j["pose"].contains("transform")) fail("{} has no transform.", where);
  const Json& t = j["pose"]["transform"];
  const std::vector<double> r = numbers_in(t, "rotation", 9, where), p = numbers_in(t, "center", 3, where);
  for (size_t i = 0; i < 3; ++i) c.world_from_cam.row[i] = {r[3 * i], r[3 * i + 1], r[3 * i + 2]};
  c.center = {p[0], p[1], p[2]};
}

std::map<std::string, const Json*> by_id(const Json& file, const char* list, const char* id,
                                         const fs::path& path) {
  if (!file.contains(list) || !file[list].is_array()) fail("{} has no list '{}'.", path.string(), list);
  std::map<std::string, const Json*> out;
  for (const Json& j : file[list])
    if (j.is_object()) out[text_in(j, id)] = &j;
  return out;
}

}  // namespace

bool detect_meshroom(const fs::path& path) { return !sfm_of(path).empty(); }

Capture load_meshroom(const fs::path& path) {
  const fs::path file = sfm_of(path);
  const Json j = read_json_file(file);
  if (!j.is_object()) fail("{} is no file of Meshroom.", file.string());
  const int version = version_of(j);
  const auto views = by_id(j, "views", "viewId", file), poses = by_id(j, "poses", "poseId", file),
             intrinsics = by_id(j, "intrinsics", "intrinsicId", file);
  Capture capture;
  capture.root = file.parent_path();
  capture.format = "meshroom";
  const PhotographIndex photographs(capture.root);
  for (const auto& [id, v] : views) {
    const std::string where = fmt::format("View {} of {}", id, file.string());
    const auto pose = poses.find(text_in(*v, "poseId")), k = intrinsics.find(text_in(*v, "intrinsicId"));
    if (pose == poses.end() || k == intrinsics.end()) continue;  // not reconstructed
    const Intrinsics in = read_intrinsics(*k->second, version, fmt::format("Intrinsics of {}", where));
    View view;
    view.image_path = photographs.find(text_in(*v, "path"));
    view.name = view_name(view.image_path.filename().string(), Split::train);
    view.camera = in.k;
    set_pose(view.camera, *pose->second, where);
    if (distorts(in.lens)) view.photo = PhotoCamera(view.camera, in.lens);
    capture.views.push_back(std::move(view));
  }
  std::sort(capture.views.begin(), capture.views.end(),
            [](const View& a, const View& b) { return a.image_path < b.image_path; });
  return capture;
}

}  // namespace cei3d
