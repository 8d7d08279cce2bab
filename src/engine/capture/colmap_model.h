// SPDX-License-Identifier: Apache-2.0
// The files of a sparse COLMAP model.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/math/lens.h"

namespace cei3d {

struct ColmapImage {
  std::string name;  // below the folder of the images, with slashes
  uint32_t camera = 0;
  Mat3d cam_from_world = Mat3d::identity();
  Vec3d translation{0, 0, 0};
  struct Point {
    Vec2d pixel;
    uint64_t id;
  };
  std::vector<Point> points;  // those that were triangulated
};

struct ColmapModel {
  struct Camera {
    cei3d::Camera k;  // size and K; no pose
    LensDistortion lens;
  };
  std::map<uint32_t, Camera> cameras;
  std::vector<ColmapImage> images;   // in the order of their names
  std::map<uint64_t, Vec3d> points;  // empty: the model has no file of points
};

// Whether the folder holds cameras and images, as .bin or as .txt.
bool is_colmap_model(const std::filesystem::path& folder);
// Number of images of the model, without reading all of it where it is binary.
size_t colmap_image_count(const std::filesystem::path& folder);
// Reads .bin where there is one, else .txt. Errors name the file: truncated, malformed, a camera model that
// is not supported, numbers that are not finite, sizes that are impossible.
ColmapModel read_colmap_model(const std::filesystem::path& folder);

}  // namespace cei3d
