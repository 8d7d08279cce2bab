// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_format.h"
#include "engine/io/heic_file.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

struct CameraFile {
  fs::path path;
  Split split;
};

std::vector<CameraFile> camera_files(const fs::path& path) {
  if (fs::is_regular_file(path)) {
    const std::string stem = path.stem().string();
    const Split split = stem == "transforms_test"  ? Split::test
                        : stem == "transforms_val" ? Split::val
                                                   : Split::train;
    return {{path, split}};
  }
  std::vector<CameraFile> files;
  for (const Split split : {Split::train, Split::val, Split::test}) {
    const fs::path file = path / fmt::format("transforms_{}.json", split_name(split));
    if (fs::exists(file)) files.push_back({file, split});
  }
  if (files.empty() && fs::exists(path / "transforms.json"))
    files.push_back({path / "transforms.json", Split::train});
  return files;
}

// The image of a name, as written or with a suffix; the first guess when no file exists.
fs::path path_of_image(const fs::path& base) {
  if (has_image_suffix(base) || is_heic(base)) return readable_image(base);
  for (const char* suffix :
       {".png", ".jpg", ".jpeg", ".exr", ".PNG", ".JPG", ".JPEG", ".EXR", ".heic", ".HEIC"})
    if (fs::exists(base.string() + suffix)) return readable_image(base.string() + suffix);
  return base.string() + ".png";
}

// A value of the frame, else of the file, under any of these keys.
std::optional<double> lookup(const Json& frame, const Json& file, std::initializer_list<const char*> keys,
                             const std::string& where) {
  for (const Json* j : {&frame, &file})
    for (const char* key : keys)
      if (j->contains(key)) return number_of((*j)[key], fmt::format("'{}' of {}", key, where));
  return std::nullopt;
}

double focal_from_angle(double angle, int pixels, const std::string& where) {
  if (!(angle > 0 && angle < 3.1415))
    fail("The field of view of {} should lie between 0 and pi radians.", where);
  return 0.5 * pixels / std::tan(0.5 * angle);
}

// The split of a frame by nerfstudio's lists of file_path; a frame on no list is a training view.
std::map<std::string, Split> listed_splits(const Json& file, const std::string& name) {
  std::map<std::string, Split> splits;
  for (const Split split : {Split::train, Split::val, Split::test}) {
    const std::string key = fmt::format("{}_filenames", split_name(split));
    if (!file.contains(key)) continue;
    if (!file[key].is_array()) fail("'{}' of {} should be a list of file names.", key, name);
    for (const Json& path : file[key]) {
      if (!path.is_string()) fail("'{}' of {} should be a list of file names.", key, name);
      splits[path.get<std::string>()] = split;
    }
  }
  return splits;
}

LensKind lens_kind(const Json& frame, const Json& file, const std::string& where) {
  for (const Json* j : {&frame, &file}) {
    if (j->contains("is_fisheye") && (*j)["is_fisheye"] == true) return LensKind::fisheye;
    if (!j->contains("camera_model")) continue;
    const Json& model = (*j)["camera_model"];
    if (model == "OPENCV_FISHEYE") return LensKind::fisheye;
    for (const char* known :
         {"OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "perspective"})
      if (model == known) return LensKind::perspective;
    fail(
        "{} has the camera model {}, which is not supported. Undistort the photographs with the program that "
        "made the cameras, and give the cameras of the undistorted ones.",
        where, model.dump());
  }
  return LensKind::perspective;
}

// k1, k2, k3, k4, p1, p2, each a number of its own or all as distortion_params, in this order.
LensDistortion read_lens(const Json& frame, const Json& file, const std::string& where) {
  LensDistortion lens;
  lens.kind = lens_kind(frame, file, where);
  double* const terms[] = {&lens.radial[0], &lens.radial[1], &lens.radial[2],
                           &lens.radial[3], &lens.p1,        &lens.p2};
  const char* const keys[] = {"k1", "k2", "k3", "k4", "p1", "p2"};
  const Json* list = nullptr;
  for (const Json* j : {&file, &frame})
    if (j->contains("distortion_params")) list = &(*j)["distortion_params"];
  if (list && (!list->is_array() || list->size() > 6))
    fail("'distortion_params' of {} should be [k1, k2, k3, k4, p1, p2].", where);
  for (size_t i = 0; i < 6; ++i) {
    double value = lookup(frame, file, {keys[i]}, where).value_or(0);
    if (list && i < list->size())
      value = number_of((*list)[i], fmt::format("'distortion_params' of {}", where));
    if (!std::isfinite(value)) fail("'{}' of {} should be a finite number.", keys[i], where);
    *terms[i] = std::abs(value) > 1e-9 ? value : 0;
  }
  return lens;
}

void set_pose(Camera& camera, const Matrix34& opengl) {
  for (int r = 0; r < 3; ++r) {
    const double* m = opengl.m[r];
    camera.world_from_cam.row[r] = {m[0], -m[1], -m[2]};  // OpenGL y up, z back -> OpenCV y down, z forward
    camera.center[r] = m[3];
  }
}

int pixels_of(double v, const std::string& where) {
  if (!(v >= 1 && v <= 65535)) fail("{} gives an impossible image size.", where);
  return int(std::lround(v));
}

void set_intrinsics(Camera& c, const Json& frame, const Json& file, ImageSize known,
                    const std::string& where) {
  const auto w = lookup(frame, file, {"w"}, where), h = lookup(frame, file, {"h"}, where);
  c.width = w ? pixels_of(*w, where) : known.width;
  c.height = h ? pixels_of(*h, where) : known.height;
  if (c.width == 0 || c.height == 0)
    fail("{}: the image size is unknown: neither the cameras nor any image gives it. Are the images missing?",
         where);
  const auto focal = lookup(frame, file, {"fl_x", "focal"}, where);
  const auto angle = lookup(frame, file, {"camera_angle_x"}, where);
  const auto angle_y = lookup(frame, file, {"camera_angle_y"}, where);
  if (!focal && !angle) fail("{} has no focal length: neither fl_x nor camera_angle_x.", where);
  c.fx = focal ? *focal : focal_from_angle(*angle, c.width, where);
  c.fy = lookup(frame, file, {"fl_y"}, where)
             .value_or(!focal && angle_y ? focal_from_angle(*angle_y, c.height, where) : c.fx);
  c.cx = lookup(frame, file, {"cx"}, where).value_or(c.width / 2.0);
  c.cy = lookup(frame, file, {"cy"}, where).value_or(c.height / 2.0);
  if (!(c.fx > 0 && c.fy > 0) || !std::isfinite(c.fx * c.fy * c.cx * c.cy))
    fail("The intrinsics of {} are impossible.", where);
}

View read_frame(const Json& frame, Split split, const fs::path& folder, const std::string& where) {
  if (!frame.is_object() || !frame.contains("file_path") || !frame["file_path"].is_string() ||
      !frame.contains("transform_matrix"))
    fail("{} lacks file_path or transform_matrix.", where);
  const std::string file_path = with_slashes(frame["file_path"]);
  if (fs::path(file_path).lexically_normal().stem().empty() || fs::path(file_path).filename() == "..")
    fail("The file_path of {} names no image.", where);
  View view;
  view.split = split;
  view.name = view_name(file_path, split);
  view.image_path = path_of_image(own_file(folder, folder / file_path, where));
  if (frame.contains("mask_path") && frame["mask_path"].is_string())
    view.mask_path = own_file(folder, folder / with_slashes(frame["mask_path"]), where);
  set_pose(view.camera, matrix_of(frame["transform_matrix"], fmt::format("transform_matrix of {}", where)));
  return view;
}

std::vector<View> read_split(const CameraFile& file) {
  const Json j = read_json_file(file.path);
  if (!j.is_object() || !j.contains("frames") || !j["frames"].is_array())
    fail("{} has no list of frames.", file.path.string());
  const std::map<std::string, Split> listed = listed_splits(j, file.path.string());
  std::vector<View> views;
  for (const Json& frame : j["frames"]) {
    views.push_back(read_frame(frame, file.split, file.path.parent_path(),
                               fmt::format("frame {} of {}", views.size(), file.path.string())));
    const auto it = listed.find(frame["file_path"].get<std::string>());
    if (it != listed.end()) views.back().split = it->second;
  }
  const bool sized = j.contains("w") && j.contains("h");
  ImageSize known;
  for (size_t i = 0; i < views.size() && known.width == 0 && !sized; ++i)
    known = size_of_image(views[i].image_path);
  for (size_t i = 0; i < views.size(); ++i) {
    const std::string where = fmt::format("frame {} of {}", i, file.path.string());
    const Json& frame = j["frames"][i];
    const ImageSize own = sized ? ImageSize() : size_of_image(views[i].image_path);
    set_intrinsics(views[i].camera, frame, j, own.width > 0 ? own : known, where);
    const LensDistortion lens = read_lens(frame, j, where);
    if (distorts(lens)) views[i].photo = PhotoCamera(views[i].camera, lens);
  }
  return views;
}

}  // namespace

bool detect_nerf(const fs::path& path) {
  if (fs::is_regular_file(path))
    return path.extension() == ".json" && path.filename().string().rfind("transforms", 0) == 0;
  return !camera_files(path).empty();
}

Capture load_nerf(const fs::path& path) {
  Capture capture;
  capture.root = fs::is_regular_file(path) ? path.parent_path() : path;
  capture.format = "nerf-synthetic";
  for (const CameraFile& file : camera_files(path))
    for (View& view : read_split(file)) capture.views.push_back(std::move(view));
  return capture;
}

std::optional<Vec3d> nerf_up(const fs::path& path) {
  for (const CameraFile& file : camera_files(path)) {
    const Json j = read_json_file(file.path);
    // "none": nerfstudio need not turn the frame to set it upright.
    if (j.contains("orientation_override") && j["orientation_override"] == "none") return Vec3d{0, 0, 1};
  }
  return std::nullopt;
}

}  // namespace cei3d
