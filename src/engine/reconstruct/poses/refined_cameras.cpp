// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/refined_cameras.h"

#include <algorithm>

#include "core/base/error.h"

namespace cei3d {

RefinedCameras refined_cameras(const Capture& capture, std::span<const Camera> given,
                               std::span<const Camera> cameras, const Normalization& normalization) {
  RefinedCameras out;
  for (const View& v : capture.views) {
    if (v.split != Split::train) continue;
    const Camera& c = cameras[out.poses.size()];
    out.poses.push_back({v.name, c.world_from_cam, normalization.capture_from_unit(c.center)});
  }
  out.focal = cameras.front().fx / given.front().fx;
  return out;
}

std::vector<Camera> refined(std::vector<Camera> cameras, const RefinedCameras& found,
                            const Normalization& normalization) {
  if (found.poses.size() != cameras.size())
    fail("There are {} poses for {} training views. Start the reconstruction anew.", found.poses.size(),
         cameras.size());
  for (size_t i = 0; i < cameras.size(); ++i) {
    cameras[i] = zoomed(cameras[i], found.focal);
    cameras[i].world_from_cam = found.poses[i].world_from_cam;
    cameras[i].center = normalization.unit_from_capture(found.poses[i].center);
  }
  return cameras;
}

bool same_cameras(std::span<const Camera> a, std::span<const Camera> b) {
  const auto same = [](Vec3d u, Vec3d v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  for (size_t i = 0; i < a.size(); ++i) {
    if (!same(a[i].center, b[i].center) || a[i].fx != b[i].fx) return false;
    for (int r = 0; r < 3; ++r)
      if (!same(a[i].world_from_cam.row[r], b[i].world_from_cam.row[r])) return false;
  }
  return a.size() == b.size();
}

bool can_change_focal(const Capture& capture) {
  return std::none_of(capture.views.begin(), capture.views.end(),
                      [](const View& v) { return v.photo && v.photo->lens().kind == LensKind::fisheye; });
}

}  // namespace cei3d
