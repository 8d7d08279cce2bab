// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/views.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

constexpr double kFieldOfView = 0.6;  // radians, of the shorter side
constexpr double kDistance = 3.5, kNearDistance = 3.4;
constexpr double kLowest = -0.5, kHighest = 0.98;  // z of the cameras' directions

Vec3d direction_at(double height, double azimuth) {
  const double r = std::sqrt(1 - height * height);
  return {r * std::cos(azimuth), r * std::sin(azimuth), height};
}

}  // namespace

Lens lens_of_size(int width, int height) {
  return {width, height, 0.5 * std::min(width, height) / std::tan(0.5 * kFieldOfView)};
}

Camera look_at(Vec3d eye, Vec3d target, const Lens& lens, Vec3d up) {
  Camera c;
  c.width = lens.width, c.height = lens.height;
  c.fx = c.fy = lens.focal;
  c.cx = 0.5 * lens.width, c.cy = 0.5 * lens.height;
  c.world_from_cam = upright_rotation(target - eye, up);
  c.center = eye;
  return c;
}

std::vector<Camera> spread_cameras(int n, const Lens& lens) {
  std::vector<Camera> cameras;
  for (int i = 0; i < n; ++i) {
    const double height = kHighest + (kLowest - kHighest) * (i + 0.5) / n;
    cameras.push_back(look_at(direction_at(height, kGoldenAngle * i) * kDistance, {0, 0, 0}, lens));
  }
  return cameras;
}

std::vector<Camera> spiral_cameras(int n, const Lens& lens) {
  std::vector<Camera> cameras;
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n, height = 0.9 + (kLowest + 0.1 - 0.9) * s;
    cameras.push_back(look_at(direction_at(height, 0.3 + 2 * M_PI * 5 * s) * kNearDistance, {0, 0, 0}, lens));
  }
  return cameras;
}

std::string view_stem(size_t index) { return fmt::format("r_{:03}", index); }

Json nerf_frame(const std::string& file_path, const Camera& c) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) {
    const Vec3d m = c.world_from_cam.row[r];
    rows.push_back({m.x, -m.y, -m.z, c.center[r]});
  }
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return {{"file_path", file_path}, {"transform_matrix", rows}};
}

void write_nerf_cameras(const std::filesystem::path& folder, const std::string& split,
                        std::span<const Camera> cameras) {
  const Camera& first = cameras.front();
  Json j{{"camera_angle_x", 2 * std::atan(0.5 * first.width / first.fx)},
         {"w", first.width},
         {"h", first.height},
         {"fl_x", first.fx},
         {"fl_y", first.fy},
         {"cx", first.cx},
         {"cy", first.cy},
         {"frames", Json::array()}};
  for (size_t i = 0; i < cameras.size(); ++i)
    j["frames"].push_back(nerf_frame("./" + split + "/" + view_stem(i), cameras[i]));
  write_file_atomic(folder / ("transforms_" + split + ".json"), j.dump(1) + "\n");
}

void write_physg_cameras(const std::filesystem::path& folder, const std::string& split,
                         std::span<const Camera> cameras) {
  Json views = Json::object();
  for (size_t i = 0; i < cameras.size(); ++i) {
    const Camera& c = cameras[i];
    const Mat3d cam_from_world = transpose(c.world_from_cam);
    const Vec3d shift = -(cam_from_world * c.center);
    Json pose = Json::array();
    for (int r = 0; r < 3; ++r) {
      const Vec3d m = cam_from_world.row[r];
      for (const double v : {m.x, m.y, m.z, shift[r]}) pose.push_back(v);
    }
    for (const double v : {0.0, 0.0, 0.0, 1.0}) pose.push_back(v);
    views[view_stem(i) + ".exr"] = {{"K",
                                     {c.fx, c.skew, c.cx - 0.5, 0.0, 0.0, c.fy, c.cy - 0.5, 0.0,  //
                                      0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}},
                                    {"W2C", pose},
                                    {"img_size", {c.width, c.height}}};
  }
  write_file_atomic(folder / split / "cam_dict_norm.json", views.dump(1) + "\n");
}

}  // namespace cei3d
