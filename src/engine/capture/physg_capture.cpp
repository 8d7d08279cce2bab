// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_format.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCameras = "cam_dict_norm.json";

struct Part {
  fs::path folder;
  Split split;
};

std::vector<Part> parts_of(const fs::path& path) {
  if (fs::is_regular_file(path)) return {{path.parent_path(), Split::train}};
  if (fs::exists(path / kCameras)) return {{path, Split::train}};
  std::vector<Part> parts;
  for (const Split split : {Split::train, Split::val, Split::test})
    if (fs::exists(path / split_name(split) / kCameras)) parts.push_back({path / split_name(split), split});
  return parts;
}

Camera read_camera(const Json& j, const std::string& where) {
  if (!j.is_object() || !j.contains("K") || !j.contains("W2C")) fail("{} lacks K or W2C.", where);
  const Matrix34 k = matrix_of(j["K"], "K of " + where), pose = matrix_of(j["W2C"], "W2C of " + where);
  Camera c;
  c.fx = k.m[0][0];
  c.fy = k.m[1][1];
  c.skew = k.m[0][1];
  c.cx = k.m[0][2] + 0.5;  // the format's pixel centers are at whole numbers
  c.cy = k.m[1][2] + 0.5;
  if (!(c.fx > 0 && c.fy > 0) || !std::isfinite(c.fx * c.fy * c.cx * c.cy * c.skew))
    fail("The intrinsics of {} are impossible.", where);
  Mat3d cam_from_world;
  for (int r = 0; r < 3; ++r) cam_from_world.row[r] = {pose.m[r][0], pose.m[r][1], pose.m[r][2]};
  c.world_from_cam = transpose(cam_from_world);
  c.center = -(c.world_from_cam * Vec3d{pose.m[0][3], pose.m[1][3], pose.m[2][3]});
  if (j.contains("img_size") && j["img_size"].is_array() && j["img_size"].size() == 2) {
    const double w = number_of(j["img_size"][0], where), h = number_of(j["img_size"][1], where);
    if (w >= 1 && w <= 65535 && h >= 1 && h <= 65535) c.width = int(w), c.height = int(h);
  }
  return c;
}

using Files = std::vector<fs::path>;

// The file of each view, by stem; by order when no stem fits and the numbers agree, as the format's own
// loader does.
Files match(const std::vector<std::string>& keys, const Files& files, const fs::path& folder,
            Capture& capture) {
  std::map<std::string, fs::path> by_stem;
  for (const fs::path& file : files) by_stem[file.stem().string()] = file;
  Files out;
  size_t found = 0;
  for (const std::string& key : keys) {
    const auto it = by_stem.find(fs::path(key).stem().string());
    found += it != by_stem.end();
    out.push_back(it != by_stem.end() ? it->second : folder / fs::path(key).filename());
  }
  if (found > 0 && found < files.size())
    capture.warnings.push_back(fmt::format("{} of {} images in {} have no camera and are left out.",
                                           files.size() - found, files.size(), folder.string()));
  if (found > 0) return out;
  if (files.size() != keys.size())
    fail("The {} images in {} fit the {} cameras neither by name nor by number. Name them as in {}.",
         files.size(), folder.string(), keys.size(), kCameras);
  capture.warnings.push_back(
      fmt::format("The images in {} are not named like the cameras; they were matched by sorted order.",
                  folder.string()));
  return files;
}

void read_part(const Part& part, Capture& capture) {
  const fs::path file = part.folder / kCameras;
  const Json j = read_json_file(file);
  if (!j.is_object()) fail("{} is not a list of cameras by image name.", file.string());
  std::vector<std::string> keys;
  for (const auto& [key, value] : j.items()) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  const Files images = images_in(part.folder / "image"), masks = images_in(part.folder / "mask");
  const Files image_of =
      images.empty() ? Files(keys.size()) : match(keys, images, part.folder / "image", capture);
  const Files mask_of =
      masks.empty() ? Files(keys.size()) : match(keys, masks, part.folder / "mask", capture);

  ImageSize size;
  for (size_t i = 0; i < keys.size() && size.width == 0; ++i) size = size_of_image(image_of[i]);
  for (size_t i = 0; i < keys.size(); ++i) {
    const std::string where = fmt::format("'{}' of {}", keys[i], file.string());
    View view;
    view.name = fmt::format("{}/{}", split_name(part.split), fs::path(keys[i]).stem().string());
    view.split = part.split;
    view.camera = read_camera(j[keys[i]], where);
    if (view.camera.width == 0) {
      const ImageSize own = size_of_image(image_of[i]);
      view.camera.width = own.width > 0 ? own.width : size.width;
      view.camera.height = own.width > 0 ? own.height : size.height;
    }
    if (view.camera.width == 0) fail("{}: neither img_size nor an image tells the image size.", where);
    view.image_path = image_of[i];
    view.mask_path = mask_of[i];
    capture.views.push_back(std::move(view));
  }
}

}  // namespace

bool detect_physg(const fs::path& path) {
  if (fs::is_regular_file(path)) return path.filename() == kCameras;
  return !parts_of(path).empty();
}

Capture load_physg(const fs::path& path) {
  Capture capture;
  capture.root = fs::is_regular_file(path) ? path.parent_path() : path;
  capture.format = "physg";
  for (const Part& part : parts_of(path)) read_part(part, capture);
  return capture;
}

}  // namespace cei3d
