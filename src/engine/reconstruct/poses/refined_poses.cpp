// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/refined_poses.h"

#include "core/base/error.h"

namespace cei3d {

std::vector<RefinedPose> refined_poses(const Capture& capture, std::span<const Camera> cameras,
                                       const Normalization& normalization) {
  std::vector<RefinedPose> poses;
  for (const View& v : capture.views) {
    if (v.split != Split::train) continue;
    const Camera& c = cameras[poses.size()];
    poses.push_back({v.name, c.world_from_cam, normalization.capture_from_unit(c.center)});
  }
  return poses;
}

std::vector<Camera> posed_cameras(std::vector<Camera> cameras, std::span<const RefinedPose> poses,
                                  const Normalization& normalization) {
  if (poses.size() != cameras.size())
    fail("there are {} poses for {} training views; start anew, in place of it", poses.size(),
         cameras.size());
  for (size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].world_from_cam = poses[i].world_from_cam;
    cameras[i].center = normalization.unit_from_capture(poses[i].center);
  }
  return cameras;
}

bool same_poses(std::span<const Camera> a, std::span<const Camera> b) {
  const auto same = [](Vec3d u, Vec3d v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  for (size_t i = 0; i < a.size(); ++i) {
    if (!same(a[i].center, b[i].center)) return false;
    for (int r = 0; r < 3; ++r)
      if (!same(a[i].world_from_cam.row[r], b[i].world_from_cam.row[r])) return false;
  }
  return a.size() == b.size();
}

}  // namespace cei3d
