// SPDX-License-Identifier: Apache-2.0
// Pinhole camera. OpenCV axes: x right, y down, z into the scene. Pixel (column, row) covers [c, c+1) x [r,
// r+1); its center is at +0.5. Loaders convert other conventions on the way in. The pose places the camera in
// the capture frame or in the unit frame, which is "the frame of the pose" here and "world" in names.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

struct Ray {
  Vec3f origin, direction;  // direction has unit length
};

struct Camera {
  int width = 0, height = 0;                        // pixels
  double fx = 0, fy = 0, cx = 0, cy = 0, skew = 0;  // pixels
  Mat3d world_from_cam = Mat3d::identity();         // rotation
  Vec3d center{0, 0, 0};                            // of the camera, in the frame of the pose

  // Ray through the continuous pixel position (u, v).
  Ray ray(double u, double v) const {
    const double y = (v - cy) / fy, x = (u - cx - skew * y) / fx;
    const Vec3d d = world_from_cam * Vec3d{x, y, 1.0};
    return {to_float(center), to_float(d / length(d))};
  }
  // Continuous pixel position (x, y) and z-depth (z) of a point in the frame of the pose; z <= 0: behind the
  // camera.
  Vec3d project(Vec3d p) const {
    const Vec3d c = transpose(world_from_cam) * (p - center);
    return {(fx * c.x + skew * c.y) / c.z + cx, fy * c.y / c.z + cy, c.z};
  }
  Vec3f forward() const {
    return to_float(Vec3d{world_from_cam.row[0].z, world_from_cam.row[1].z, world_from_cam.row[2].z});
  }
};

// world_from_cam of an upright camera that looks along `forward`. up: not parallel to it; neither needs unit
// length.
inline Mat3d upright_rotation(Vec3d forward, Vec3d up) {
  const Vec3d z = normalize(forward), x = normalize(cross(z, up)), y = cross(z, x);
  return transpose(Mat3d{{x, y, z}});
}

// The camera of the image at 1/n of its size. Columns and rows that do not fill an n x n block are cut off.
inline Camera scaled(Camera c, int n) {
  c.width /= n;
  c.height /= n;
  c.fx /= n;
  c.fy /= n;
  c.cx /= n;
  c.cy /= n;
  c.skew /= n;
  return c;
}

// The camera with `factor` times the focal length; the principal point stays.
inline Camera zoomed(Camera c, double factor) {
  c.fx *= factor;
  c.fy *= factor;
  c.skew *= factor;
  return c;
}

}  // namespace cei3d
