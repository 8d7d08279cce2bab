// SPDX-License-Identifier: Apache-2.0
#include "model/light/envmap.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/quick_angles.h"

namespace cei3d {

Vec3f env_direction(float u, float v, int width, int height, EnvUp up) {
  const float theta = kPi * v / float(height), s = std::sin(theta), c = std::cos(theta);
  if (up == EnvUp::z) {
    const float phi = 2 * kPi * (0.5f - u / float(width));
    return {s * std::cos(phi), s * std::sin(phi), c};
  }
  const float phi = 2 * kPi * u / float(width) - 0.5f * kPi;
  return {s * std::cos(phi), c, s * std::sin(phi)};
}

namespace {

// angle_of_cosine, angle_of: acos() and atan2().
template <class Acos, class Atan2>
Vec2f pixel_of(Vec3f d, int width, int height, EnvUp up, Acos angle_of_cosine, Atan2 angle_of) {
  const float along = up == EnvUp::z ? d.z : d.y;
  const float v = angle_of_cosine(clamp(along, -1.0f, 1.0f)) / kPi * float(height);
  const float turn =
      up == EnvUp::z ? 0.5f - angle_of(d.y, d.x) / (2 * kPi) : angle_of(d.z, d.x) / (2 * kPi) + 0.25f;
  float u = (turn - std::floor(turn)) * float(width);
  if (u >= float(width)) u = 0;
  return {u, v};
}

EnvTaps taps_at(Vec2f p, int width, int height) {
  const float x = p.x - 0.5f, y = clamp(p.y - 0.5f, 0.0f, float(height - 1));
  const int x0 = int(std::floor(x)), y0 = std::min(int(y), height - 1), y1 = std::min(y0 + 1, height - 1);
  const float fx = x - float(x0), fy = y - float(y0);
  const int left = x0 < 0 ? x0 + width : x0, right = x0 + 1 < width ? x0 + 1 : 0;
  return {{y0 * width + left, y0 * width + right, y1 * width + left, y1 * width + right},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

}  // namespace

Vec2f env_pixel(Vec3f d, int width, int height, EnvUp up) {
  return pixel_of(
      d, width, height, up, [](float x) { return std::acos(x); },
      [](float y, float x) { return std::atan2(y, x); });
}

float env_solid_angle(int v, int width, int height) {
  const double top = std::cos(M_PI * v / height), bottom = std::cos(M_PI * (v + 1) / height);
  return float(2 * M_PI / width * (top - bottom));
}

EnvTaps env_taps(Vec3f direction, int width, int height, EnvUp up) {
  return taps_at(env_pixel(direction, width, height, up), width, height);
}

EnvTaps quick_env_taps(Vec3f direction, int width, int height) {
  return taps_at(pixel_of(direction, width, height, EnvUp::z, quick_acos, quick_atan2), width, height);
}

Vec3f env_radiance(const Image& map, Vec3f direction, EnvUp up) {
  const EnvTaps t = env_taps(direction, map.width, map.height, up);
  Vec3f sum{0, 0, 0};
  for (int k = 0; k < 4; ++k) {
    const float* p = &map.data[size_t(t.pixel[k]) * map.channels];
    sum += Vec3f{p[0], p[1], p[2]} * t.weight[k];
  }
  return sum;
}

Image lat_long(const SgMixture& light, int height, EnvUp up) {
  Image out(2 * height, height, 3);
  parallel_for(height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const Vec3f l =
          radiance(light, env_direction(float(x) + 0.5f, float(y) + 0.5f, out.width, out.height, up));
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = l[c];
    }
  });
  return out;
}

Image env_resample(const Image& map, int height) {
  const int width = 2 * height;
  Image out(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // Area mean over source pixels, fractional at the borders, rows weighted by their solid angle.
      const double x0 = double(x) * map.width / width, x1 = double(x + 1) * map.width / width;
      const double y0 = double(y) * map.height / height, y1 = double(y + 1) * map.height / height;
      double sum[3] = {0, 0, 0}, total = 0;
      for (int v = int(y0); v < std::min(map.height, int(std::ceil(y1))); ++v)
        for (int u = int(x0); u < std::min(map.width, int(std::ceil(x1))); ++u) {
          const double cover = (std::min<double>(u + 1, x1) - std::max<double>(u, x0)) *
                               (std::cos(M_PI * std::max<double>(v, y0) / map.height) -
                                std::cos(M_PI * std::min<double>(v + 1, y1) / map.height));
          const Vec3f c = map.rgb(u, v);
          for (int k = 0; k < 3; ++k) sum[k] += cover * c[k];
          total += cover;
        }
      for (int k = 0; k < 3; ++k) out.at(x, y)[k] = float(sum[k] / total);
    }
  return out;
}

}  // namespace cei3d
