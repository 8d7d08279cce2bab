// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/capture_format.h"
#include "engine/io/npy.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPoses = "poses_bounds.npy";

// 3 x 5, row-major: columns down, right, backwards | center | height, width, focal length.
Camera read_camera(const double* m, const std::string& where) {
  for (int i = 0; i < 15; ++i)
    if (!std::isfinite(m[i])) fail("{} holds a number that is not finite.", where);
  Camera c;
  for (int r = 0; r < 3; ++r) {
    const double* row = m + 5 * r;
    c.world_from_cam.row[r] = {row[1], row[0], -row[2]};
    c.center[r] = row[3];
  }
  const double height = m[4], width = m[9];
  if (!(width >= 1 && width <= 65535 && height >= 1 && height <= 65535))
    fail("{} gives an impossible image size.", where);
  c.width = int(std::lround(width)), c.height = int(std::lround(height));
  c.fx = c.fy = m[14];
  c.cx = c.width / 2.0, c.cy = c.height / 2.0;
  if (!(c.fx > 0)) fail("{} has a focal length that is not positive.", where);
  return c;
}

}  // namespace

bool detect_llff(const fs::path& path) {
  return fs::is_regular_file(path) ? path.filename() == kPoses : fs::exists(path / kPoses);
}

Capture load_llff(const fs::path& path) {
  const fs::path file = fs::is_regular_file(path) ? path : path / kPoses;
  Capture capture;
  capture.root = file.parent_path();
  capture.format = "llff";
  const NpyArray poses = decode_npy(read_file(file), file.string());
  if (poses.shape.size() != 2 || poses.shape[1] != 17)
    fail("{} should be an array of N x 17.", file.string());
  std::vector<fs::path> images;
  for (const char* folder : {"images", "images_4", "images_8", "images_2"})
    if (images.empty()) images = images_in(capture.root / folder);
  if (images.size() != size_t(poses.shape[0]))
    fail(
        "{} has {} cameras, but {} has {} images. The format joins them by sorted order, so none may be "
        "missing.",
        file.string(), poses.shape[0], (capture.root / "images").string(), images.size());
  for (size_t i = 0; i < images.size(); ++i) {
    View view;
    view.name = view_name(images[i].filename().string(), Split::train);
    view.image_path = images[i];
    view.camera = read_camera(&poses.data[17 * i], fmt::format("Row {} of {}", i, file.string()));
    capture.views.push_back(std::move(view));
  }
  return capture;
}

}  // namespace cei3d
