// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/window_match.h"

#include <algorithm>
#include <cmath>

#include "core/math/bilinear.h"

namespace cei3d {

namespace {

constexpr int kSums = 6;           // number of sums over a window: 1, a, b, aa, bb, ab
constexpr float kNoise = 1e-4f;    // variance of a window without texture; gray values are 0 to 1
constexpr float kMinKnown = 0.6f;  // minimum share of a window's pixels that are known

}  // namespace

Warp warp_between(const Camera& a, const Camera& b) {
  const Mat3d cam_from_world = transpose(b.world_from_cam);
  const auto pixel = [&](Vec3d c) {
    return Vec3d{b.fx * c.x + b.skew * c.y + b.cx * c.z, b.fy * c.y + b.cy * c.z, c.z};
  };
  const auto direction = [&](double u, double v) {  // z = 1
    const double y = (v - a.cy) / a.fy, x = (u - a.cx - a.skew * y) / a.fx;
    return pixel(cam_from_world * (a.world_from_cam * Vec3d{x, y, 1.0}));
  };
  const Vec3d origin = direction(0, 0);
  return {origin, direction(1, 0) - origin, direction(0, 1) - origin,
          pixel(cam_from_world * (a.center - b.center))};
}

WindowMatcher::WindowMatcher(const Gray& a, int window)
    : a_(a),
      window_(window),
      width_(a.camera.width),
      rows_(size_t(2 * window + 1)),
      columns_(kSums * padded(), 0.0f),
      sums_(size_t(kSums) * size_t(width_)),
      warped_(padded()),
      known_(padded()) {
  for (auto& r : rows_) r.assign(kSums * padded(), 0.0f);
}

void WindowMatcher::match(const Gray& b, const Warp& warp, double depth, std::vector<float>& score) {
  std::fill(columns_.begin(), columns_.end(), 0.0f);
  for (auto& r : rows_) std::fill(r.begin(), r.end(), 0.0f);
  const int height = a_.camera.height;
  for (int y = 0; y < height + window_; ++y) {
    std::vector<float>& row = rows_[y % rows_.size()];
    for (size_t i = 0; i < columns_.size(); ++i) columns_[i] -= row[i];
    if (y < height)
      sample(b, warp, depth, y, row);
    else
      std::fill(row.begin(), row.end(), 0.0f);
    for (size_t i = 0; i < columns_.size(); ++i) columns_[i] += row[i];
    if (y >= window_) correlate(&score[a_.at(0, y - window_)], y - window_);
  }
}

void WindowMatcher::sample(const Gray& b, const Warp& w, double depth, int y, std::vector<float>& row) {
  const Vec3f start = to_float((w.column + w.dx * 0.5 + w.dy * (y + 0.5)) * depth + w.offset),
              step = to_float(w.dx * depth);
  const float max_x = float(b.camera.width) - 1.001f, max_y = float(b.camera.height) - 1.001f;
  const float* inside = &a_.inside[a_.at(0, y)];
  const float* value = &a_.value[a_.at(0, y)];
  const size_t stride = size_t(b.camera.width);
  for (int x = 0; x < width_; ++x) {
    float g = 0, known = 0;
    if (inside[x] > 0) {
      const Vec3f h = start + step * float(x);
      const float u = h.x / h.z - 0.5f, v = h.y / h.z - 0.5f;
      if (h.z > 0 && u >= 0 && v >= 0 && u < max_x && v < max_y) {
        const int i = int(u), j = int(v);
        const float s = u - float(i), t = v - float(j);
        const size_t k = size_t(j) * stride + size_t(i);
        known = b.inside[k] * b.inside[k + 1] * b.inside[k + stride] * b.inside[k + stride + 1];
        g = bilinear({b.value[k], b.value[k + 1], b.value[k + stride], b.value[k + stride + 1]}, s, t);
      }
    }
    warped_[x] = g * known;
    known_[x] = known;
  }
  float* sums[kSums];
  for (int k = 0; k < kSums; ++k) sums[k] = &row[k * padded() + window_];
  for (int x = 0; x < width_; ++x) {
    const float g = warped_[x], a = value[x] * known_[x];
    sums[0][x] = known_[x];
    sums[1][x] = a;
    sums[2][x] = g;
    sums[3][x] = a * a;
    sums[4][x] = g * g;
    sums[5][x] = a * g;
  }
}

void WindowMatcher::correlate(float* score, int y) {
  const float* inside = &a_.inside[a_.at(0, y)];
  const float min_known = kMinKnown * float(rows_.size() * rows_.size());
  for (int k = 0; k < kSums; ++k) {
    float* sum = &sums_[k * width_];
    std::fill(sum, sum + width_, 0.0f);
    for (size_t i = 0; i < rows_.size(); ++i) {
      const float* c = &columns_[k * padded() + i];
      for (int x = 0; x < width_; ++x) sum[x] += c[x];
    }
  }
  const auto sum = [&](int k) { return &sums_[k * width_]; };
  const float *sum_1 = sum(0), *sum_a = sum(1), *sum_b = sum(2), *sum_aa = sum(3), *sum_bb = sum(4),
              *sum_ab = sum(5);
  for (int x = 0; x < width_; ++x) {
    const float n = std::max(sum_1[x], 1.0f), a = sum_a[x] / n, b = sum_b[x] / n;
    const float aa = sum_aa[x] / n - a * a + kNoise, bb = sum_bb[x] / n - b * b + kNoise,
                ab = sum_ab[x] / n - a * b;
    const float r = ab / std::sqrt(std::max(aa * bb, 1e-12f));
    score[x] = sum_1[x] * inside[x] > min_known ? r : -1.0f;
  }
}

}  // namespace cei3d
