// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/ssim.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/base/error.h"

namespace cei3d {
namespace {

constexpr int kWindow = 11;
constexpr double kC1 = 1e-4, kC2 = 9e-4;  // (K1 range)^2, (K2 range)^2

std::array<double, kWindow> gaussian() {
  std::array<double, kWindow> k;
  double sum = 0;
  for (int i = 0; i < kWindow; ++i)
    sum += k[size_t(i)] = std::exp(-0.5 * std::pow((i - kWindow / 2) / 1.5, 2));
  for (double& v : k) v /= sum;
  return k;
}

struct Plane {
  int width, height;
  std::vector<double> v;
};

Plane plane(const Image& a, int ca, const Image* b, int cb) {  // channel of a, or product with one of b
  Plane p{a.width, a.height, std::vector<double>(size_t(a.width) * a.height)};
  for (size_t i = 0; i < p.v.size(); ++i)
    p.v[i] = a.data[3 * i + size_t(ca)] * (b ? double(b->data[3 * i + size_t(cb)]) : 1.0);
  return p;
}

// Where the whole window fits: 10 columns and rows fewer.
Plane blur(const Plane& in) {
  static const std::array<double, kWindow> k = gaussian();
  Plane rows{in.width, in.height - kWindow + 1, {}}, out{in.width - kWindow + 1, in.height - kWindow + 1, {}};
  rows.v.assign(size_t(rows.width) * rows.height, 0.0);
  out.v.assign(size_t(out.width) * out.height, 0.0);
  for (int y = 0; y < rows.height; ++y)
    for (int j = 0; j < kWindow; ++j)
      for (int x = 0; x < rows.width; ++x)
        rows.v[size_t(y) * rows.width + x] += k[size_t(j)] * in.v[size_t(y + j) * in.width + x];
  for (int y = 0; y < out.height; ++y)
    for (int j = 0; j < kWindow; ++j)
      for (int x = 0; x < out.width; ++x)
        out.v[size_t(y) * out.width + x] += k[size_t(j)] * rows.v[size_t(y) * rows.width + x + j];
  return out;
}

// SSIM of each window; see blur().
Plane ssim_map(const Image& a, const Image& b, int c) {
  const Plane ma = blur(plane(a, c, nullptr, 0)), mb = blur(plane(b, c, nullptr, 0));
  const Plane aa = blur(plane(a, c, &a, c)), bb = blur(plane(b, c, &b, c));
  Plane map = blur(plane(a, c, &b, c));
  for (size_t i = 0; i < map.v.size(); ++i) {
    const double mx = ma.v[i], my = mb.v[i];
    const double sx = aa.v[i] - mx * mx, sy = bb.v[i] - my * my, sxy = map.v[i] - mx * my;
    map.v[i] = (2 * mx * my + kC1) * (2 * sxy + kC2) / ((mx * mx + my * my + kC1) * (sx + sy + kC2));
  }
  return map;
}

void require_pair(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != 3 || b.channels != 3 || a.width < kWindow ||
      a.height < kWindow)
    fail("SSIM needs two RGB images of one size, at least {} x {} pixels; got {} x {} x {} and {} x {} x {}.",
         kWindow, kWindow, a.width, a.height, a.channels, b.width, b.height, b.channels);
}

}  // namespace

double ssim(const Image& a, const Image& b) {
  return *ssim_in_area(a, b, Area(size_t(a.width) * a.height, 1));
}

std::optional<double> ssim_in_area(const Image& a, const Image& b, const Area& area) {
  require_pair(a, b);
  if (area.size() != size_t(a.width) * a.height)
    fail("An area of {} pixels does not fit an image of {} x {}.", area.size(), a.width, a.height);
  double sum = 0;
  size_t windows = 0;
  for (int c = 0; c < 3; ++c) {
    const Plane map = ssim_map(a, b, c);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        if (!area[size_t(y + kWindow / 2) * a.width + x + kWindow / 2]) continue;
        sum += map.v[size_t(y) * map.width + x];
        ++windows;
      }
  }
  if (windows == 0) return std::nullopt;
  return sum / double(windows);
}

}  // namespace cei3d
