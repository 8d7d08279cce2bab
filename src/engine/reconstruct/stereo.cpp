// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/stereo.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"

namespace cei3d {

namespace {

constexpr double kBestAngle = 0.2;  // between the two views of a pair, radians: less tells little, more looks different
constexpr double kLeastAngle = 0.05, kMostAngle = 0.7;
constexpr int kMostPlanes = 256;
constexpr float kNoise = 1e-4f;  // variance of a window without texture; grey values are 0 to 1

// A grey picture of the object, shrunk.
struct Grey {
  Camera camera;
  std::vector<float> value;   // [y][x], about zero
  std::vector<float> inside;  // 1: all its pixels are on the object; else 0
  size_t at(int x, int y) const { return size_t(y) * camera.width + x; }
};

int shrink_for(const PixelStore& pixels, size_t most) {
  int factor = 1;
  while (pixels.pixels().size() / size_t(factor * factor) > most) ++factor;
  return factor;
}

std::vector<Grey> grey_pictures(const PixelStore& pixels, int factor) {
  std::vector<Grey> out;
  for (const Camera& c : pixels.cameras()) {
    Grey g{scaled(c, factor), {}, {}};
    g.value.assign(size_t(g.camera.width) * g.camera.height, 0);
    g.inside = g.value;
    out.push_back(std::move(g));
  }
  for (const Pixel& p : pixels.pixels()) {
    Grey& g = out[p.view];
    const int x = p.x / factor, y = p.y / factor;
    if (x >= g.camera.width || y >= g.camera.height || p.srgba[3] < 255) continue;
    g.value[g.at(x, y)] += (0.3f * float(p.srgba[0]) + 0.6f * float(p.srgba[1]) + 0.1f * float(p.srgba[2])) / 255;
    g.inside[g.at(x, y)] += 1;
  }
  const float all = float(factor * factor);
  for (Grey& g : out)
    for (size_t i = 0; i < g.value.size(); ++i) {
      g.inside[i] = g.inside[i] == all;
      g.value[i] = g.inside[i] > 0 ? g.value[i] / all - 0.5f : 0;
    }
  return out;
}

// The views whose angle to this one, seen from the origin, is nearest to the best.
std::vector<int> neighbours_of(int view, const std::vector<Grey>& pictures, int most) {
  const Vec3d here = normalize(pictures[view].camera.center);
  std::vector<std::pair<double, int>> ranked;
  for (int v = 0; v < int(pictures.size()); ++v) {
    const double angle = std::acos(std::clamp(dot(here, normalize(pictures[v].camera.center)), -1.0, 1.0));
    if (v != view && angle > kLeastAngle && angle < kMostAngle)
      ranked.push_back({std::abs(std::log(angle / kBestAngle)), v});
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> out;
  for (int k = 0; k < std::min(most, int(ranked.size())); ++k) out.push_back(ranked[k].second);
  return out;
}

// Planes z = const before a camera, evenly spaced in 1 / z, about a pixel of parallax apart.
struct Planes {
  double near, far;
  int count;
  double depth(double k) const {
    const double t = k / (count - 1);
    return 1 / ((1 - t) / near + t / far);
  }
  double step_at(double z) const { return z * z * (1 / near - 1 / far) / (count - 1); }
};

Planes planes_for(const Camera& camera, const std::vector<Vec3d>& corners, double baseline) {
  Planes p{1e9, 0, 0};
  for (const Vec3d& c : corners) {
    const double z = camera.project(c).z;
    p.near = std::min(p.near, z);
    p.far = std::max(p.far, z);
  }
  p.near = std::max(p.near, 0.05 * p.far);
  const double parallax = camera.fx * baseline * (1 / p.near - 1 / p.far);
  p.count = std::clamp(int(parallax) + 2, 8, kMostPlanes);
  return p;
}

// Where the points of the plane at z = 1 before `a` lie in `b`'s picture, homogeneous: z (column + x dx + y dy) + offset.
struct Warp {
  Vec3d column, dx, dy, offset;
};

Warp warp_between(const Camera& a, const Camera& b) {
  const Mat3d cam_from_world = transpose(b.world_from_cam);
  const auto pixel = [&](Vec3d c) { return Vec3d{b.fx * c.x + b.skew * c.y + b.cx * c.z, b.fy * c.y + b.cy * c.z, c.z}; };
  const auto direction = [&](double u, double v) {  // z = 1
    const double y = (v - a.cy) / a.fy, x = (u - a.cx - a.skew * y) / a.fx;
    return pixel(cam_from_world * (a.world_from_cam * Vec3d{x, y, 1.0}));
  };
  const Vec3d origin = direction(0, 0);
  return {origin, direction(1, 0) - origin, direction(0, 1) - origin, pixel(cam_from_world * (a.center - b.center))};
}

constexpr int kSums = 6;  // of a window: 1, a, b, aa, bb, ab

// Correlation of a picture's windows with another's, warped by a plane.
class Matcher {
 public:
  Matcher(const Grey& a, int window)
      : a_(a), window_(window), width_(a.camera.width), rows_(2 * window + 1), columns_(kSums * padded(), 0.0f),
        sums_(size_t(kSums) * width_), warped_(padded()), known_(padded()) {
    for (auto& r : rows_) r.assign(kSums * padded(), 0.0f);
  }

  // score: [y][x], -1 where it cannot be told.
  void match(const Grey& b, const Warp& warp, double depth, std::vector<float>& score) {
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

 private:
  size_t padded() const { return size_t(width_) + 2 * window_; }

  // The products of row y, `window_` columns of zeros on both sides.
  void sample(const Grey& b, const Warp& w, double depth, int y, std::vector<float>& row) {
    const Vec3f start = to_float((w.column + w.dx * 0.5 + w.dy * (y + 0.5)) * depth + w.offset), step = to_float(w.dx * depth);
    const float most_x = float(b.camera.width) - 1.001f, most_y = float(b.camera.height) - 1.001f;
    const float* inside = &a_.inside[a_.at(0, y)];
    const float* value = &a_.value[a_.at(0, y)];
    const size_t stride = size_t(b.camera.width);
    for (int x = 0; x < width_; ++x) {
      float g = 0, known = 0;
      if (inside[x] > 0) {
        const Vec3f h = start + step * float(x);
        const float u = h.x / h.z - 0.5f, v = h.y / h.z - 0.5f;
        if (h.z > 0 && u >= 0 && v >= 0 && u < most_x && v < most_y) {
          const int i = int(u), j = int(v);
          const float s = u - float(i), t = v - float(j);
          const size_t k = size_t(j) * stride + size_t(i);
          known = b.inside[k] * b.inside[k + 1] * b.inside[k + stride] * b.inside[k + stride + 1];
          g = (1 - t) * ((1 - s) * b.value[k] + s * b.value[k + 1]) + t * ((1 - s) * b.value[k + stride] + s * b.value[k + stride + 1]);
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

  void correlate(float* score, int y) {
    const float* inside = &a_.inside[a_.at(0, y)];
    const float least = 0.6f * float(rows_.size() * rows_.size());
    for (int k = 0; k < kSums; ++k) {
      float* sum = &sums_[k * width_];
      std::fill(sum, sum + width_, 0.0f);
      for (size_t i = 0; i < rows_.size(); ++i) {
        const float* c = &columns_[k * padded() + i];
        for (int x = 0; x < width_; ++x) sum[x] += c[x];
      }
    }
    const auto sum = [&](int k) { return &sums_[k * width_]; };
    const float *sum_1 = sum(0), *sum_a = sum(1), *sum_b = sum(2), *sum_aa = sum(3), *sum_bb = sum(4), *sum_ab = sum(5);
    for (int x = 0; x < width_; ++x) {
      const float n = std::max(sum_1[x], 1.0f), a = sum_a[x] / n, b = sum_b[x] / n;
      const float aa = sum_aa[x] / n - a * a + kNoise, bb = sum_bb[x] / n - b * b + kNoise, ab = sum_ab[x] / n - a * b;
      const float r = ab / std::sqrt(std::max(aa * bb, 1e-12f));
      score[x] = sum_1[x] * inside[x] > least ? r : -1.0f;
    }
  }

  const Grey& a_;
  int window_, width_;
  std::vector<std::vector<float>> rows_;  // products of the last rows
  std::vector<float> columns_;            // their sums
  std::vector<float> sums_;               // of windows
  std::vector<float> warped_, known_;
};

struct Estimate {
  std::vector<float> depth;
  Planes planes{1, 2, 2};
};

Estimate sweep(int view, const std::vector<Grey>& pictures, const std::vector<Vec3d>& corners, const StereoOptions& options) {
  const Grey& a = pictures[view];
  const size_t n = a.value.size();
  Estimate out{std::vector<float>(n, 0.0f), {}};
  const std::vector<int> others = neighbours_of(view, pictures, options.neighbours);
  if (others.size() < 2) return out;
  double baseline = 0;
  std::vector<Warp> warps;
  for (const int o : others) {
    baseline = std::max(baseline, length(pictures[o].camera.center - a.camera.center));
    warps.push_back(warp_between(a.camera, pictures[o].camera));
  }
  out.planes = planes_for(a.camera, corners, baseline);
  Matcher matcher(a, options.window);
  std::vector<float> score(n), first(n), second(n), last(n, -1.0f), best(n, -1.0f), before(n, -1.0f), after(n, -1.0f);
  std::vector<int> plane(n, -9);
  for (int k = 0; k < out.planes.count; ++k) {
    std::fill(first.begin(), first.end(), -1.0f);
    std::fill(second.begin(), second.end(), -1.0f);
    for (size_t o = 0; o < others.size(); ++o) {
      matcher.match(pictures[others[o]], warps[o], out.planes.depth(k), score);
      for (size_t i = 0; i < n; ++i) {
        second[i] = std::max(second[i], std::min(first[i], score[i]));
        first[i] = std::max(first[i], score[i]);
      }
    }
    for (size_t i = 0; i < n; ++i) {
      const float s = 0.5f * (first[i] + second[i]);
      if (plane[i] == k - 1) after[i] = s;
      if (s > best[i]) {
        best[i] = s;
        plane[i] = k;
        before[i] = last[i];
        after[i] = -1;
      }
      last[i] = s;
    }
  }
  for (size_t i = 0; i < n; ++i) {
    if (best[i] < options.least_score) continue;
    const float bend = before[i] + after[i] - 2 * best[i];  // a parabola through the three
    const float shift = bend < -1e-6f ? std::clamp(0.5f * (before[i] - after[i]) / bend, -0.5f, 0.5f) : 0.0f;
    out.depth[i] = float(out.planes.depth(plane[i] + shift));
  }
  return out;
}

Vec3d point_at(const Camera& c, int x, int y, double depth) {
  const double v = (y + 0.5 - c.cy) / c.fy, u = (x + 0.5 - c.cx - c.skew * v) / c.fx;
  return c.center + c.world_from_cam * Vec3d{u * depth, v * depth, depth};
}

// The pixel's depth in a map, or 0.
float depth_at(const Camera& c, const std::vector<float>& depth, Vec3d projected) {
  if (!(projected.z > 0 && projected.x >= 0 && projected.y >= 0 && projected.x < c.width && projected.y < c.height)) return 0;
  return depth[size_t(projected.y) * size_t(c.width) + size_t(projected.x)];
}

std::vector<Vec3d> corners_of(const VisualHull& hull) {
  const Vec3d cell = to_double(hull.hi - hull.lo) / double(hull.n);
  Vec3d lo{1e9, 1e9, 1e9}, hi{-1e9, -1e9, -1e9};
  for (int z = 0; z < hull.n; ++z)
    for (int y = 0; y < hull.n; ++y)
      for (int x = 0; x < hull.n; ++x) {
        if (!hull.inside[(size_t(z) * hull.n + y) * hull.n + x]) continue;
        const int i[] = {x, y, z};
        for (int k = 0; k < 3; ++k) {
          lo[k] = std::min(lo[k], hull.lo[k] + cell[k] * i[k]);
          hi[k] = std::max(hi[k], hull.lo[k] + cell[k] * (i[k] + 1));
        }
      }
  std::vector<Vec3d> out;
  for (int k = 0; k < 8; ++k) out.push_back({k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z});
  return out;
}

}  // namespace

std::vector<DepthMap> stereo_depths(const PixelStore& pixels, const VisualHull& hull, const StereoOptions& options) {
  const std::vector<Grey> pictures = grey_pictures(pixels, shrink_for(pixels, options.pixels));
  const std::vector<Vec3d> corners = corners_of(hull);
  std::vector<Estimate> estimates(pictures.size());
  parallel_for(int(pictures.size()), [&](int v) { estimates[v] = sweep(v, pictures, corners, options); });
  std::vector<DepthMap> out(pictures.size());
  parallel_for(int(pictures.size()), [&](int v) {
    const Camera& camera = pictures[v].camera;
    out[v] = {camera, estimates[v].depth};
    const std::vector<int> others = neighbours_of(v, pictures, options.neighbours);
    for (size_t i = 0; i < out[v].depth.size(); ++i) {
      if (out[v].depth[i] == 0) continue;
      const Vec3d p = point_at(camera, int(i % size_t(camera.width)), int(i / size_t(camera.width)), out[v].depth[i]);
      int agree = 0;
      for (const int o : others) {
        const Vec3d there = pictures[o].camera.project(p);
        const float z = depth_at(pictures[o].camera, estimates[o].depth, there);
        agree += z > 0 && std::abs(z - there.z) < options.agreement * estimates[o].planes.step_at(there.z);
      }
      if (!agree) out[v].depth[i] = 0;
    }
  });
  return out;
}

VisualHull carve_by_depths(const VisualHull& hull, std::span<const DepthMap> maps) {
  constexpr float kTruncation = 3;  // cells
  constexpr float kLeastViews = 3;
  const Vec3d cell = to_double(hull.hi - hull.lo) / double(hull.n);
  const float most = kTruncation * float(cell.x);
  VisualHull out = hull;
  parallel_for(hull.n, [&](int z) {
    for (int y = 0; y < hull.n; ++y)
      for (int x = 0; x < hull.n; ++x) {
        uint8_t& inside = out.inside[(size_t(z) * hull.n + y) * hull.n + x];
        if (!inside) continue;
        const Vec3d p = to_double(hull.lo) + Vec3d{cell.x * (x + 0.5), cell.y * (y + 0.5), cell.z * (z + 0.5)};
        float sum = 0, views = 0;
        for (const DepthMap& m : maps) {
          const Vec3d there = m.camera.project(p);
          const float depth = depth_at(m.camera, m.depth, there), before = depth - float(there.z);
          if (depth == 0 || before < -most) continue;
          sum += std::min(before, most);
          ++views;
        }
        if (views >= kLeastViews && sum > 0) inside = 0;
      }
  });
  return out;
}

}  // namespace cei3d
