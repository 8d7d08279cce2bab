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

double ssim_channel(const Image& a, const Image& b, int c) {
  const Plane ma = blur(plane(a, c, nullptr, 0)), mb = blur(plane(b, c, nullptr, 0));
  const Plane aa = blur(plane(a, c, &a, c)), bb = blur(plane(b, c, &b, c)), ab = blur(plane(a, c, &b, c));
  double sum = 0;
  for (size_t i = 0; i < ma.v.size(); ++i) {
    const double mx = ma.v[i], my = mb.v[i];
    const double sx = aa.v[i] - mx * mx, sy = bb.v[i] - my * my, sxy = ab.v[i] - mx * my;
    sum += (2 * mx * my + kC1) * (2 * sxy + kC2) / ((mx * mx + my * my + kC1) * (sx + sy + kC2));
  }
  return sum / double(ma.v.size());
}

}  // namespace

double ssim(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != 3 || b.channels != 3 || a.width < kWindow ||
      a.height < kWindow)
    fail(
        "SSIM needs two RGB pictures of one size, at least {} x {} pixels; got {} x {} x {} and {} x {} x "
        "{}.",
        kWindow, kWindow, a.width, a.height, a.channels, b.width, b.height, b.channels);
  return (ssim_channel(a, b, 0) + ssim_channel(a, b, 1) + ssim_channel(a, b, 2)) / 3;
}

}  // namespace cei3d
