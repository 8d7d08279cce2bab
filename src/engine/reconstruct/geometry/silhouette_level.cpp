// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/silhouette_level.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core/base/cancel.h"
#include "core/math/quantile.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "engine/reconstruct/geometry/occupancy.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {
namespace {

constexpr size_t kRays = 16384;      // through silhouette pixels
constexpr size_t kMinPixels = 1000;  // on the silhouette
constexpr size_t kSlab = 64;         // rays at a time: with the largest networks 2 to 3 s of one core
constexpr float kStep = 0.005f;      // along rays, coarse
constexpr int kFine = 16;            // fine steps, from a coarse one before the lowest value to one behind it

// Pixels that the silhouette runs through: partly covered, or, where masks are black and white, next to a
// pixel of the other kind.
std::vector<Pixel> silhouette_pixels(const PixelStore& store) {
  std::vector<Pixel> half, border;
  for (const Pixel& p : store.pixels()) {
    if (p.srgba[3] > 0 && p.srgba[3] < 255) half.push_back(p);
    const Camera& camera = store.cameras()[p.view];
    const auto object = [&, &mask = store.masks()[p.view]](int x, int y) {
      return mask[size_t(std::clamp(y, 0, camera.height - 1)) * camera.width +
                  std::clamp(x, 0, camera.width - 1)];
    };
    const auto here = object(p.x, p.y);
    const auto other = [&](int x, int y) { return object(x, y) != here && object(x, y) != kUnknown; };
    if (other(p.x - 1, p.y) || other(p.x + 1, p.y) || other(p.x, p.y - 1) || other(p.x, p.y + 1))
      border.push_back(p);
  }
  return half.size() >= kMinPixels ? half : border;
}

// Lowest value of the field along each ray, and its depth. The field is evaluated at depths first + k step,
// k < count.
struct Lowest {
  float value = std::numeric_limits<float>::max(), depth = 0;
};
struct Stretch {
  float first, step;
  int count;
};
std::vector<Lowest> lowest(const Device& device, const Field& sdf, std::span<const Ray> rays,
                           std::span<const Stretch> stretches) {
  std::vector<Vec3f> points;
  for (size_t i = 0; i < rays.size(); ++i)
    for (int k = 0; k < stretches[i].count; ++k)
      points.push_back(rays[i].origin +
                       rays[i].direction * (stretches[i].first + float(k) * stretches[i].step));
  const std::vector<float> values = first_output(device, sdf, points);
  std::vector<Lowest> out(rays.size());
  size_t next = 0;
  for (size_t i = 0; i < rays.size(); ++i)
    for (int k = 0; k < stretches[i].count; ++k, ++next)
      if (values[next] < out[i].value)
        out[i] = {values[next], stretches[i].first + float(k) * stretches[i].step};
  return out;
}

std::vector<Lowest> lowest_along(const Device& device, const Field& sdf, std::span<const Ray> rays) {
  std::vector<Stretch> stretches;
  for (const Ray& ray : rays) {
    const auto [near, far] = sphere_span(ray, 1);
    stretches.push_back({near, kStep, near < far ? int((far - near) / kStep) + 1 : 0});
  }
  const std::vector<Lowest> coarse = lowest(device, sdf, rays, stretches);
  for (size_t i = 0; i < rays.size(); ++i)
    if (stretches[i].count) stretches[i] = {coarse[i].depth - kStep, 2 * kStep / kFine, kFine + 1};
  return lowest(device, sdf, rays, stretches);
}

}  // namespace

float silhouette_level(const Device& device, const Field& sdf, const PixelStore& store, float max_level,
                       uint64_t seed, const Progress& progress) {
  const std::vector<Pixel> pixels = silhouette_pixels(store);
  if (pixels.size() < kMinPixels) return 0;
  std::vector<Ray> rays;
  double coverage = 0;
  for (size_t i = 0; i < kRays; ++i) {
    Rng rng(seed ^ 0x51f0, 0, i);
    const Pixel& p = pixels[rng.below(uint32_t(pixels.size()))];
    // Spread like the pixel's own filter, a tent of radius one pixel (core/math/sub_pixel.h).
    const float u = rng.uniform() + rng.uniform() - 1, v = rng.uniform() + rng.uniform() - 1;
    rays.push_back(store.ray(p, {u, v}));
    coverage += double(p.srgba[3]) / 255 / double(kRays);
  }
  std::vector<float> values;
  for (size_t begin = 0; begin < kRays; begin += kSlab) {
    check_cancelled(progress);
    for (const Lowest& l : lowest_along(device, sdf, std::span(rays).subspan(begin, kSlab)))
      values.push_back(l.value);
  }
  // A ray meets the level set of every value above its lowest one.
  const float level = value_of_rank(std::move(values), size_t(coverage * double(kRays - 1)));
  return std::clamp(level, -max_level, max_level);
}

}  // namespace cei3d
