// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/stroke.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/math/color.h"
#include "core/math/quantile.h"
#include "model/geometry/shape/point_index.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr float kHard = 0.5f, kSoft = 0.5f / 255;  // min_alpha
constexpr float kMinFacing = 0.1f;  // minimum cosine between the normal and the direction to the camera
constexpr int kMaxScale = 4;
constexpr int64_t kMaxRays = 300000;    // maximum number of rays through the crop: about half a second
constexpr int64_t kMaxPainted = 60000;  // painted rays: as many as training uses anyway

bool beside_opaque(const Image& rgba, int x, int y) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, rgba.height - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, rgba.width - 1); ++u)
      if (rgba.at(u, v)[3] > 1 - kSoft) return true;
  return false;
}

int count_painted(const Image& rgba) {
  const float threshold = min_alpha(rgba);
  int n = 0;
  for (size_t i = 3; i < rgba.data.size(); i += 4) n += rgba.data[i] >= threshold;
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

struct Pixel {
  int x, y;
};

// The painted pixel nearest to (u, v), in pixels of the crop; none: none is adjacent.
std::optional<Pixel> nearest_painted(const Stroke& s, float u, float v) {
  std::optional<Pixel> best;
  float best_distance = 1e9f;
  const int cx = int(u), cy = int(v);
  for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, s.alpha.height - 1); ++y) {
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, s.alpha.width - 1); ++x) {
      if (*s.alpha.at(x, y) < s.min_alpha) continue;
      const float d = square(float(x) + 0.5f - u) + square(float(y) + 0.5f - v);
      if (d >= best_distance) continue;
      best_distance = d;
      best = {x, y};
    }
  }
  return best;
}

// Distance between the hits of neighboring rays; slopes count up to a factor of 4, beyond which rays are
// sparse anyway.
float footprint(const Camera& camera, const Hit& hit, float depth) {
  return depth / float(camera.fx) / max(dot(hit.normal, hit.to_camera), 0.25f);
}

// Whether there is paint less than a pixel of the scribble away.
bool is_beside(const Projector& mask, double u, double v, int scale) {
  for (const Vec2<double> d : {Vec2<double>{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    if (mask.alpha_at(u + d.x * scale, v + d.y * scale) > 0) return true;
  return false;
}

void add_hit(Stroke& s, const Projector& mask, int x, int y, const Hit& hit, float depth) {
  if (dot(hit.normal, hit.to_camera) <= kMinFacing) return;
  const float coverage = mask.alpha_at(x + 0.5, y + 0.5);
  if (coverage <= 0 && is_beside(mask, x + 0.5, y + 0.5, s.scale)) {
    s.beside.push_back(hit);
    s.beside_footprints.push_back(footprint(s.camera, hit, depth));
  }
  const std::optional<Pixel> painted =
      nearest_painted(s, (float(x) + 0.5f) / float(s.scale), (float(y) + 0.5f) / float(s.scale));
  if (coverage <= 0 || !painted) return;
  s.hits.push_back(hit);
  s.targets.push_back(s.colors.rgb(painted->x, painted->y));
  s.opacity.push_back(*s.alpha.at(painted->x, painted->y));
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
  const float threshold = min_alpha(rgba);
  int x0 = rgba.width, y0 = rgba.height, x1 = -1, y1 = -1;
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      if (rgba.at(x, y)[3] < threshold) continue;
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

Image without_unchanged(const Device& device, const Scene& scene, const Camera& camera, const Image& rgba,
                        int& unchanged) {
  constexpr float kStep = 1.5f / 255;
  Image left = rgba;
  unchanged = 0;
  const PixelBox box = painted_box(rgba, 2);  // with the neighbors that the pixels' filter reaches
  if (box.width == 0) return left;
  const GBuffer traced = trace_view(device, scene, crop_camera(camera, box, 1), 2);
  Appearance look = appearance_at(device, scene, traced.hits);
  constexpr float kNoAlbedo = 2;  // of surface shown without light: paint on it makes it lit
  for (size_t i = 0; i < look.unlit.size(); ++i)
    if (look.unlit[i] > 0) look.albedo[i] = {kNoAlbedo, kNoAlbedo, kNoAlbedo};
  const Image shown = filtered_albedo(traced, look.albedo);
  const float threshold = min_alpha(rgba);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x) {
      float* painted = left.at(box.x0 + x, box.y0 + y);
      const float* now = shown.at(x, y);
      if (painted[3] < threshold || now[3] == 0) continue;
      const auto same = [&](int c) { return std::abs(srgb_from_linear(now[c]) - painted[c]) < kStep; };
      if (!same(0) || !same(1) || !same(2)) continue;
      painted[3] = 0;
      ++unchanged;
    }
  return left;
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

Projector stroke_projector(const Stroke& s) {
  Projector projector;
  projector.camera = s.camera;
  projector.alpha = s.alpha;
  projector.depth = s.depth;
  projector.min_facing = kMinFacing;
  projector.min_alpha = s.min_alpha;
  return projector;
}

// Points of one label.
struct Labeled {
  std::vector<Hit> hits;
  std::vector<float> footprints;
  void add(const Hit& hit, float footprint) {
    hits.push_back(hit);
    footprints.push_back(footprint);
  }
};

// The handler points that the stroke's view shows in its crop, by whether they are in the paint.
void label_known(const Stroke& s, const HandlerPoints& known, Labeled& in, Labeled& out) {
  const Projector paint = stroke_projector(s);
  Projector all = paint;
  all.min_alpha = 0;
  for (size_t i = 0; i < known.positions.size(); ++i) {
    const Vec3f p = known.positions[i], n = known.normals[i];
    if (all.covers(p, n)) (paint.covers(p, n) ? in : out).add({p, n, n, 0, 0, 0}, known.footprints[i]);
  }
}

// Hits without a known point within the spacing, thinned to it.
HandlerPoints refinement(const Labeled& known, const Labeled& hits, float spacing) {
  std::vector<Vec3f> positions = positions_of(known.hits);
  const PointIndex index = positions.empty() ? PointIndex() : PointIndex(positions, spacing);
  Labeled left;
  for (size_t i = 0; i < hits.hits.size(); ++i) {
    const Hit& h = hits.hits[i];
    const auto on_its_side = [&](size_t k) { return dot(known.hits[k].normal, h.normal) > 0; };
    if (!index.any_within(h.position, spacing, on_its_side)) left.add(h, hits.footprints[i]);
  }
  return thin_hits(left.hits, left.footprints, spacing);
}

void append(const Labeled& known, const HandlerPoints& fine, float spacing, bool edited, Region::Points& to) {
  // Every ray has a point within the spacing; surface between rays is less than 1.5 footprints away from one.
  const auto reach = [&](float footprint) { return spacing + 1.5f * footprint; };
  for (size_t i = 0; i < known.hits.size(); ++i) {
    to.positions.push_back(known.hits[i].position);
    to.normals.push_back(known.hits[i].normal);
    to.reach.push_back(reach(known.footprints[i]));
  }
  for (size_t i = 0; i < fine.positions.size(); ++i) {
    to.positions.push_back(fine.positions[i]);
    to.normals.push_back(fine.normals[i]);
    to.reach.push_back(reach(fine.footprints[i]));
  }
  to.edited.resize(to.positions.size(), edited);
}

// H+ alone, with the same reach for all.
Region::Points within(const Region::Points& points, float theta) {
  Region::Points out;
  for (size_t i = 0; i < points.positions.size(); ++i) {
    if (!points.is_edited(i)) continue;
    out.positions.push_back(points.positions[i]);
    out.normals.push_back(points.normals[i]);
    out.reach.push_back(theta);
  }
  return out;
}

}  // namespace

Region::Points refine_and_label(const Stroke& s, const HandlerPoints* known, size_t& added) {
  Labeled known_in, known_out, in, out{s.beside, s.beside_footprints};
  if (known) label_known(s, *known, known_in, known_out);
  for (size_t i = 0; i < s.hits.size(); ++i)
    (s.coverage[i] >= s.min_alpha ? in : out).add(s.hits[i], s.footprints[i]);
  added = 0;
  if (in.hits.empty()) return {};
  const float spacing = 0.5f * float(s.scale) * median(in.footprints);  // two points per pixel and direction
  const HandlerPoints fine_in = refinement(known_in, in, spacing),
                      fine_out = refinement(known_out, out, spacing);
  added = fine_in.positions.size() + fine_out.positions.size();
  Region::Points points;
  append(known_in, fine_in, spacing, true, points);
  append(known_out, fine_out, spacing, false, points);
  return points;
}

Region stroke_region(const Stroke& s, Region::Points points, Routing routing, float theta) {
  if (routing == Routing::outline) return Region({}, stroke_projector(s));
  if (points.positions.empty()) return {};
  if (routing != Routing::points) return Region(std::move(points), stroke_projector(s));
  return Region(theta > 0 ? within(points, theta) : std::move(points), Projector{});
}

}  // namespace cei3d
