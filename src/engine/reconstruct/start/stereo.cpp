// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/stereo.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "engine/reconstruct/start/window_match.h"

namespace cei3d {

namespace {

// Between the two views of a pair, radians: with less there is little parallax, with more the images differ
// too much.
constexpr double kBestAngle = 0.2;
constexpr double kMinAngle = 0.05, kMaxAngle = 0.7;
constexpr int kMaxPlanes = 256;

int shrink_for(const PixelStore& pixels, size_t max_pixels) {
  int factor = 1;
  while (pixels.pixels().size() / size_t(factor * factor) > max_pixels) ++factor;
  return factor;
}

// The part of the image that shows the object; most images are mostly background.
Gray cropped(const Gray& g) {
  int x0 = g.camera.width, y0 = g.camera.height, x1 = 0, y1 = 0;
  for (int y = 0; y < g.camera.height; ++y)
    for (int x = 0; x < g.camera.width; ++x)
      if (g.inside[g.at(x, y)] > 0) {
        x0 = std::min(x0, x), x1 = std::max(x1, x + 1);
        y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
      }
  Gray out{g.camera, {}, {}};
  out.camera.width = std::max(x1 - x0, 0);
  out.camera.height = std::max(y1 - y0, 0);
  out.camera.cx -= x0;
  out.camera.cy -= y0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      out.value.push_back(g.value[g.at(x, y)]);
      out.inside.push_back(g.inside[g.at(x, y)]);
    }
  return out;
}

std::vector<Gray> gray_images(const PixelStore& pixels, int factor) {
  std::vector<Gray> out;
  for (const Camera& c : pixels.cameras()) {
    Gray g{scaled(c, factor), {}, {}};
    g.value.assign(size_t(g.camera.width) * g.camera.height, 0);
    g.inside = g.value;
    out.push_back(std::move(g));
  }
  for (const Pixel& p : pixels.pixels()) {
    Gray& g = out[p.view];
    const int x = p.x / factor, y = p.y / factor;
    if (x >= g.camera.width || y >= g.camera.height || p.srgba[3] < 255) continue;
    g.value[g.at(x, y)] +=
        (0.3f * float(p.srgba[0]) + 0.6f * float(p.srgba[1]) + 0.1f * float(p.srgba[2])) / 255;
    g.inside[g.at(x, y)] += 1;
  }
  const float all = float(factor * factor);
  for (Gray& g : out) {
    for (size_t i = 0; i < g.value.size(); ++i) {
      g.inside[i] = g.inside[i] == all;
      g.value[i] = g.inside[i] > 0 ? g.value[i] / all - 0.5f : 0;
    }
    g = cropped(g);
  }
  return out;
}

// The views whose angle to this one, seen from the origin, is nearest to the optimum.
std::vector<int> neighbors_of(int view, const std::vector<Gray>& images, int max_count) {
  const Vec3d here = normalize(images[view].camera.center);
  std::vector<std::pair<double, int>> ranked;
  for (int v = 0; v < int(images.size()); ++v) {
    const double angle = std::acos(std::clamp(dot(here, normalize(images[v].camera.center)), -1.0, 1.0));
    if (v != view && angle > kMinAngle && angle < kMaxAngle)
      ranked.push_back({std::abs(std::log(angle / kBestAngle)), v});
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> out;
  for (int k = 0; k < std::min(max_count, int(ranked.size())); ++k) out.push_back(ranked[k].second);
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
  p.count = std::clamp(int(parallax) + 2, 8, kMaxPlanes);
  return p;
}

// The best plane of each pixel, with the scores of the planes before and after it.
class Peaks {
 public:
  explicit Peaks(size_t pixels)
      : plane_(pixels, -9), best_(pixels, -1.0f), before_(best_), after_(best_), last_(best_) {}

  // Plane after plane.
  void add(int plane, const std::vector<float>& score) {
    for (size_t i = 0; i < score.size(); ++i) {
      if (plane_[i] == plane - 1) after_[i] = score[i];
      if (score[i] > best_[i]) {
        best_[i] = score[i];
        plane_[i] = plane;
        before_[i] = last_[i];
        after_[i] = -1;
      }
      last_[i] = score[i];
    }
  }
  float score(size_t pixel) const { return best_[pixel]; }
  // Between the planes: where a parabola through the three scores is highest.
  double position(size_t i) const {
    const float bend = before_[i] + after_[i] - 2 * best_[i];
    if (bend > -1e-6f) return plane_[i];
    return plane_[i] + std::clamp(0.5f * (before_[i] - after_[i]) / bend, -0.5f, 0.5f);
  }

 private:
  std::vector<int> plane_;
  std::vector<float> best_, before_, after_, last_;
};

struct Estimate {
  std::vector<float> depth;
  Planes planes{1, 2, 2};
};

// Every plane's score is the mean of the two images that agree best with it: the point may be hidden in the
// others.
Estimate sweep(int view, const std::vector<Gray>& images, const std::vector<Vec3d>& corners,
               const StereoOptions& options, const Progress& progress) {
  const Gray& a = images[view];
  const size_t n = a.value.size();
  Estimate out{std::vector<float>(n, 0.0f), {}};
  const std::vector<int> others = neighbors_of(view, images, options.neighbors);
  if (others.size() < 2) return out;
  double baseline = 0;
  std::vector<Warp> warps;
  for (const int o : others) {
    baseline = std::max(baseline, length(images[o].camera.center - a.camera.center));
    warps.push_back(warp_between(a.camera, images[o].camera));
  }
  out.planes = planes_for(a.camera, corners, baseline);
  WindowMatcher matcher(a, options.window);
  Peaks peaks(n);
  std::vector<float> score(n), first(n), second(n);
  for (int k = 0; k < out.planes.count && !progress.cancelled(); ++k) {
    std::fill(first.begin(), first.end(), -1.0f);
    std::fill(second.begin(), second.end(), -1.0f);
    for (size_t o = 0; o < others.size(); ++o) {
      matcher.match(images[others[o]], warps[o], out.planes.depth(k), score);
      for (size_t i = 0; i < n; ++i) {
        second[i] = std::max(second[i], std::min(first[i], score[i]));
        first[i] = std::max(first[i], score[i]);
      }
    }
    for (size_t i = 0; i < n; ++i) score[i] = 0.5f * (first[i] + second[i]);
    peaks.add(k, score);
  }
  for (size_t i = 0; i < n; ++i)
    if (peaks.score(i) >= options.min_score) out.depth[i] = float(out.planes.depth(peaks.position(i)));
  return out;
}

Vec3d point_at(const Camera& c, int x, int y, double depth) {
  const double v = (y + 0.5 - c.cy) / c.fy, u = (x + 0.5 - c.cx - c.skew * v) / c.fx;
  return c.center + c.world_from_cam * Vec3d{u * depth, v * depth, depth};
}

// The pixel's depth in a map, or 0.
float depth_at(const Camera& c, const std::vector<float>& depth, Vec3d projected) {
  if (!(projected.z > 0 && projected.x >= 0 && projected.y >= 0 && projected.x < c.width &&
        projected.y < c.height))
    return 0;
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

std::vector<DepthMap> stereo_depths(const PixelStore& pixels, const VisualHull& hull,
                                    const StereoOptions& options, const Progress& progress) {
  const std::vector<Gray> images = gray_images(pixels, shrink_for(pixels, options.pixels));
  const std::vector<Vec3d> corners = corners_of(hull);
  std::vector<Estimate> estimates(images.size());
  parallel_for(int(images.size()), [&](int v) {
    if (!progress.cancelled()) estimates[v] = sweep(v, images, corners, options, progress);
  });
  check_cancelled(progress);
  std::vector<DepthMap> out(images.size());
  parallel_for(int(images.size()), [&](int v) {
    const Camera& camera = images[v].camera;
    out[v] = {camera, estimates[v].depth};
    const std::vector<int> others = neighbors_of(v, images, options.neighbors);
    for (size_t i = 0; i < out[v].depth.size(); ++i) {
      if (out[v].depth[i] == 0) continue;
      const Vec3d p =
          point_at(camera, int(i % size_t(camera.width)), int(i / size_t(camera.width)), out[v].depth[i]);
      int agree = 0;
      for (const int o : others) {
        const Vec3d there = images[o].camera.project(p);
        const float z = depth_at(images[o].camera, estimates[o].depth, there);
        agree += z > 0 && std::abs(z - there.z) < options.agreement * estimates[o].planes.step_at(there.z);
      }
      if (!agree) out[v].depth[i] = 0;
    }
  });
  return out;
}

VisualHull carve_by_depths(const VisualHull& hull, std::span<const DepthMap> maps) {
  constexpr float kTruncation = 3;  // cells
  constexpr float kMinViews = 3;
  const Vec3d cell = to_double(hull.hi - hull.lo) / double(hull.n);
  const float largest = kTruncation * float(cell.x);
  VisualHull out = hull;
  parallel_for(hull.n, [&](int z) {
    for (int y = 0; y < hull.n; ++y)
      for (int x = 0; x < hull.n; ++x) {
        uint8_t& inside = out.inside[(size_t(z) * hull.n + y) * hull.n + x];
        if (!inside) continue;
        const Vec3d p =
            to_double(hull.lo) + Vec3d{cell.x * (x + 0.5), cell.y * (y + 0.5), cell.z * (z + 0.5)};
        float sum = 0, views = 0;
        for (const DepthMap& m : maps) {
          const Vec3d there = m.camera.project(p);
          const float depth = depth_at(m.camera, m.depth, there), before = depth - float(there.z);
          if (depth == 0 || before < -largest) continue;
          sum += std::min(before, largest);
          ++views;
        }
        if (views >= kMinViews && sum > 0) inside = 0;
      }
  });
  return out;
}

}  // namespace cei3d
