// SPDX-License-Identifier: Apache-2.0
#include "model/scene/view.h"

namespace cei3d {

namespace {

Camera posed(Camera camera, const RefinedPose& pose) {
  camera.world_from_cam = pose.world_from_cam;
  camera.center = pose.center;
  return camera;
}

void zoom(View& v, double focal) {
  v.camera = zoomed(v.camera, focal);
  if (v.photo) v.photo = PhotoCamera(zoomed(v.photo->camera(), focal), zoomed(v.photo->lens(), focal));
}

}  // namespace

Capture with_cameras(Capture capture, const RefinedCameras& refined) {
  for (View& v : capture.views) {
    if (refined.focal != 1) zoom(v, refined.focal);
    for (const RefinedPose& pose : refined.poses) {
      if (v.name != pose.view) continue;
      v.camera = posed(v.camera, pose);
      if (v.photo) v.photo = PhotoCamera(posed(v.photo->camera(), pose), v.photo->lens());
    }
  }
  return capture;
}

}  // namespace cei3d
