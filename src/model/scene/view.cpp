// SPDX-License-Identifier: Apache-2.0
#include "model/scene/view.h"

namespace cei3d {

namespace {

Camera posed(Camera camera, const RefinedPose& pose) {
  camera.world_from_cam = pose.world_from_cam;
  camera.center = pose.center;
  return camera;
}

}  // namespace

Capture with_poses(Capture capture, std::span<const RefinedPose> poses) {
  for (View& v : capture.views)
    for (const RefinedPose& pose : poses) {
      if (v.name != pose.view) continue;
      v.camera = posed(v.camera, pose);
      if (v.photo) v.photo = PhotoCamera(posed(v.photo->camera(), pose), v.photo->lens());
    }
  return capture;
}

}  // namespace cei3d
