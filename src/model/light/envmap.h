// SPDX-License-Identifier: Apache-2.0
// Latitude-longitude images of distant light. Conventions: docs/method.md#environment-maps.
#pragma once

#include "core/image/image.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

// Direction of row 0 of the image.
enum class EnvUp {
  z,  // row 0 = +Z; center = +X, column W/4 = +Y, 3W/4 = -Y, borders = -X
  y,  // row 0 = +Y; left border -Z, column W/4 = +X, center = +Z, 3W/4 = -X (Mitsuba)
};

// Unit direction towards the light at the continuous pixel position (u, v) of a width x height image.
Vec3f env_direction(float u, float v, int width, int height, EnvUp up = EnvUp::z);
// Pixel position of a direction, the inverse of env_direction(): u in [0, width), v in [0, height].
Vec2f env_pixel(Vec3f direction, int width, int height, EnvUp up = EnvUp::z);
// Solid angle of each pixel of row v, in steradians.
float env_solid_angle(int v, int width, int height);

// The four pixels around a direction and their bilinear weights; columns wrap, rows end at the poles.
struct EnvTaps {
  int pixel[4];  // row * width + column
  float weight[4];
};
EnvTaps env_taps(Vec3f direction, int width, int height, EnvUp up = EnvUp::z);
// The same within 1e-4 of the image's width, in three fifths of the time; EnvUp::z.
EnvTaps quick_env_taps(Vec3f direction, int width, int height);
// Bilinear lookup. map: 3 or more channels.
Vec3f env_radiance(const Image& map, Vec3f direction, EnvUp up = EnvUp::z);

// 2 x height by height pixels, the radiance at their centers.
Image lat_long(const SgMixture& light, int height, EnvUp up = EnvUp::z);

// The image resampled to height rows and 2 height columns, each pixel the mean radiance over its solid angle.
Image env_resample(const Image& map, int height);

}  // namespace cei3d
