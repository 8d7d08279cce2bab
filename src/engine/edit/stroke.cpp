// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/stroke.h"

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/math/quantile.h"

namespace cei3d {
namespace {

constexpr float kHard = 0.5f, kSoft = 0.5f / 255;  // min_alpha
constexpr float kMinFacing = 0.1f;  // minimum cosine between the normal and the direction to the camera
constexpr int kMaxScale = 4;
constexpr int64_t kMaxRays = 300000;    // in the crop: about half a second
constexpr int64_t kMaxPainted = 60000;  // painted rays: as many as training uses anyway

bool beside_opaque(const Image& rgba, int x, int y) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, rgba.height - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, rgba.width - 1); ++u)
      if (rgba.at(u, v)[3] > 1 - kSoft) return true;
  return false;
}

int count_painted(const Image& rgba) {
  const float least = min_alpha(rgba);
  int n = 0;
  for (size_t i = 3; i < rgba.data.size(); i += 4) n += rgba.data[i] >= least;
  return n;
}

int affordable_scale(const PixelBox& box, int painted) {
  int scale = kMaxScale;
  while (scale > 1 && (int64_t(box.width) * box.height * scale * scale > kMaxRays ||
                       int64_t(painted) * scale * scale > kMaxPainted))
    --scale;
  return scale;
}

void cut_out(const Image& rgba, const PixelBox& box, Stroke& stroke) {
  stroke.colors = Image(box.width, box.height, 3);
  stroke.alpha = Image(box.width, box.height, 1);
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      const float* p = rgba.at(box.x0 + x, box.y0 + y);
      for (int c = 0; c < 3; ++c) stroke.colors.at(x, y)[c] = linear_from_srgb(p[c]);
      *stroke.alpha.at(x, y) = p[3];
    }
  }
}

// Color of the painted pixel nearest to (u, v), in pixels of the crop; null: none is adjacent.
const float* nearest_color(const Stroke& s, float u, float v) {
  const float* best = nullptr;
  float best_distance = 1e9f;
  const int cx = int(u), cy = int(v);
  for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, s.alpha.height - 1); ++y) {
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, s.alpha.width - 1); ++x) {
      if (*s.alpha.at(x, y) < s.min_alpha) continue;
      const float d = square(float(x) + 0.5f - u) + square(float(y) + 0.5f - v);
      if (d >= best_distance) continue;
      best_distance = d;
      best = s.colors.at(x, y);
    }
  }
  return best;
}

// Distance between the hits of neighboring rays; slopes count up to a factor of 4, beyond which rays are
// sparse anyway.
float footprint(const Camera& camera, const Hit& hit, float depth) {
  return depth / float(camera.fx) / max(dot(hit.normal, hit.to_camera), 0.25f);
}

void add_hit(Stroke& s, const Projector& mask, int x, int y, const Hit& hit, float depth) {
  if (dot(hit.normal, hit.to_camera) <= kMinFacing) return;
  const float coverage = mask.alpha_at(x + 0.5, y + 0.5);
  const float* color =
      nearest_color(s, (float(x) + 0.5f) / float(s.scale), (float(y) + 0.5f) / float(s.scale));
  if (coverage <= 0 || !color) return;
  s.hits.push_back(hit);
  s.targets.push_back({color[0], color[1], color[2]});
  s.coverage.push_back(coverage);
  s.footprints.push_back(footprint(s.camera, hit, depth));
}

// Number of painted pixels without any painted hit.
int count_missed(const Stroke& s, const std::vector<uint8_t>& reached) {
  int missed = 0;
  for (size_t i = 0; i < reached.size(); ++i) missed += s.alpha.data[i] >= s.min_alpha && !reached[i];
  return missed;
}

}  // namespace

float min_alpha(const Image& rgba) {
  int veils = 0, edges = 0;
  for (int y = 0; y < rgba.height; ++y)
    for (int x = 0; x < rgba.width; ++x) {
      const float alpha = rgba.at(x, y)[3];
      if (alpha >= kSoft && alpha <= 1 - kSoft) ++(beside_opaque(rgba, x, y) ? edges : veils);
    }
  return veils > edges ? kSoft : kHard;
}

PixelBox painted_box(const Image& rgba, int margin) {
  const float least = min_alpha(rgba);
  int x0 = rgba.width, y0 = rgba.height, x1 = -1, y1 = -1;
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      if (rgba.at(x, y)[3] < least) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  if (x1 < 0) return {};
  x0 = std::max(x0 - margin, 0);
  y0 = std::max(y0 - margin, 0);
  x1 = std::min(x1 + margin, rgba.width - 1);
  y1 = std::min(y1 + margin, rgba.height - 1);
  return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

Stroke trace_stroke(const Device& device, const Scene& scene, const Camera& camera, const Image& rgba) {
  Stroke s;
  const PixelBox box = painted_box(rgba, 2);
  s.painted_pixels = count_painted(rgba);
  if (s.painted_pixels == 0) return s;
  s.min_alpha = min_alpha(rgba);
  s.scale = affordable_scale(box, s.painted_pixels);
  s.camera = crop_camera(camera, box, s.scale);
  cut_out(rgba, box, s);
  const GBuffer traced = trace_view(device, scene, s.camera, 1);
  s.depth = Image(traced.width, traced.height, 1);
  Projector mask;
  mask.camera = s.camera;
  mask.alpha = s.alpha;
  std::vector<uint8_t> reached(s.alpha.data.size(), 0);
  for (int y = 0; y < traced.height; ++y) {
    for (int x = 0; x < traced.width; ++x) {
      const size_t pixel = size_t(y) * traced.width + x;
      const uint32_t h = traced.pixel_start[pixel];
      if (h == traced.pixel_start[pixel + 1]) continue;
      *s.depth.at(x, y) = traced.depths[h];
      const size_t before = s.hits.size();
      add_hit(s, mask, x, y, traced.hits[h], traced.depths[h]);
      if (s.hits.size() > before) reached[size_t(y / s.scale) * s.alpha.width + x / s.scale] = 1;
    }
  }
  s.missed_pixels = count_missed(s, reached);
  return s;
}

namespace {

// The edited handler points with their reach.
Region::Points stroke_points(const Stroke& s) {
  std::vector<Hit> painted;
  std::vector<float> footprints;
  for (size_t i = 0; i < s.hits.size(); ++i) {
    if (s.coverage[i] < s.min_alpha) continue;
    painted.push_back(s.hits[i]);
    footprints.push_back(s.footprints[i]);
  }
  if (painted.empty()) return {};
  const float spacing = 0.5f * float(s.scale) * median(footprints);  // two points per pixel and direction
  HandlerPoints handlers = thin_hits(painted, footprints, spacing);
  Region::Points points{std::move(handlers.positions), std::move(handlers.normals),
                        std::move(handlers.footprints)};
  // Every painted ray has a point within the spacing; a surface point between rays is less than 1.5
  // footprints away from one of them.
  for (float& r : points.reach) r = spacing + 1.5f * r;
  return points;
}

Projector stroke_projector(const Stroke& s) {
  Projector projector;
  projector.camera = s.camera;
  projector.alpha = s.alpha;
  projector.depth = s.depth;
  projector.min_facing = kMinFacing;
  projector.min_alpha = s.min_alpha;
  return projector;
}

}  // namespace

Region stroke_region(const Stroke& s, Routing routing) {
  if (routing == Routing::outline) return Region({}, stroke_projector(s));
  Region::Points points = stroke_points(s);
  if (points.positions.empty()) return {};
  return Region(std::move(points), routing == Routing::points ? Projector{} : stroke_projector(s));
}

}  // namespace cei3d
