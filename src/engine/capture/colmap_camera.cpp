// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/colmap_camera.h"

#include <cmath>

#include "core/base/error.h"

namespace cei3d {
namespace {

// Ids and numbers of parameters as COLMAP defines them.
constexpr ColmapCameraModel kModels[] = {
    {0, "SIMPLE_PINHOLE", 3},
    {1, "PINHOLE", 4},
    {2, "SIMPLE_RADIAL", 4},
    {3, "RADIAL", 5},
    {4, "OPENCV", 8},
    {5, "OPENCV_FISHEYE", 8},
    {6, "FULL_OPENCV", 12},
    {7, "FOV", 0},
    {8, "SIMPLE_RADIAL_FISHEYE", 4},
    {9, "RADIAL_FISHEYE", 5},
    {10, "THIN_PRISM_FISHEYE", 0},
    {11, "RAD_TAN_THIN_PRISM_FISHEYE", 0},
    {12, "SIMPLE_DIVISION", 0},
    {13, "DIVISION", 0},
    {14, "SIMPLE_FISHEYE", 3},
    {15, "FISHEYE", 4},
    {16, "EUCM", 0},
    {17, "EQUIRECTANGULAR", 0},
};
constexpr char kUndistort[] =
    "Undistort the images with `colmap image_undistorter` and use the folder that it writes.";

const ColmapCameraModel& supported(const ColmapCameraModel& model, const std::string& where) {
  if (model.params == 0)
    fail("{} has the camera model {}, which is not supported. {}", where, model.name, kUndistort);
  return model;
}

[[noreturn]] void fail_unknown(const std::string& model, const std::string& where) {
  fail("{} has the camera model '{}', which is not known: the file is damaged, or of a newer COLMAP. {}",
       where, model, kUndistort);
}

bool has_two_focal_lengths(int id) { return id == 1 || id == 4 || id == 5 || id == 6 || id == 15; }

LensDistortion lens_of(int id, std::span<const double> rest) {
  LensDistortion lens;
  if (id == 5 || id == 8 || id == 9 || id == 14 || id == 15) {
    lens.kind = LensKind::fisheye;
    std::copy(rest.begin(), rest.end(), lens.radial.begin());
    return lens;
  }
  for (size_t i = 0; i < 2 && i < rest.size(); ++i) lens.radial[i] = rest[i];
  if (rest.size() >= 4) lens.p1 = rest[2], lens.p2 = rest[3];
  if (rest.size() == 8) lens.radial[2] = rest[4], lens.divisor = {rest[5], rest[6], rest[7]};
  return lens;
}

}  // namespace

const ColmapCameraModel& colmap_camera_model(int id, const std::string& where) {
  for (const ColmapCameraModel& m : kModels)
    if (m.id == id) return supported(m, where);
  fail_unknown(std::to_string(id), where);
}

const ColmapCameraModel& colmap_camera_model(const std::string& name, const std::string& where) {
  for (const ColmapCameraModel& m : kModels)
    if (m.name == name) return supported(m, where);
  fail_unknown(name.substr(0, 40), where);
}

ColmapModel::Camera colmap_camera(const ColmapCameraModel& model, double width, double height,
                                  std::span<const double> params, const std::string& where) {
  for (const double p : params)
    if (!std::isfinite(p)) fail("{} has a parameter that is not finite.", where);
  if (!(width >= 1 && width <= 65535 && height >= 1 && height <= 65535))
    fail("{} gives an impossible image size.", where);
  const size_t focal = has_two_focal_lengths(model.id) ? 2 : 1;
  ColmapModel::Camera out;
  out.k.width = int(width), out.k.height = int(height);
  out.k.fx = params[0], out.k.fy = params[focal - 1];
  out.k.cx = params[focal], out.k.cy = params[focal + 1];
  if (!(out.k.fx > 0 && out.k.fy > 0)) fail("{} has a focal length that is not positive.", where);
  out.lens = lens_of(model.id, params.subspan(focal + 2));
  return out;
}

}  // namespace cei3d
