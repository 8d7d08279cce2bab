// SPDX-License-Identifier: Apache-2.0
// The camera models of COLMAP.
#pragma once

#include <span>
#include <string>

#include "engine/capture/colmap_model.h"

namespace cei3d {

struct ColmapCameraModel {
  int id;
  const char* name;
  size_t params;  // 0: not supported
};
// Errors: unknown, or not supported, with what to do. where: for the message.
const ColmapCameraModel& colmap_camera_model(int id, const std::string& where);
const ColmapCameraModel& colmap_camera_model(const std::string& name, const std::string& where);

// params: as many as the model has. Errors: not finite, a focal length or size that is not positive.
ColmapModel::Camera colmap_camera(const ColmapCameraModel&, double width, double height,
                                  std::span<const double> params, const std::string& where);

}  // namespace cei3d
