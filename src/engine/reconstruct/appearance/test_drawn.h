// SPDX-License-Identifier: Apache-2.0
// A painted body under a known light, drawn by the shading model, to be taken apart again.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/reconstruct/appearance/linear_split.h"
#include "engine/render/lighting.h"

namespace cei3d {

// A bumpy ball, so that directions and places don't coincide.
inline Mesh bumpy_ball(int n = 40) {
  Mesh m;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float t = kPi * float(i) / float(n), p = kPi * float(j) / float(n);
      const Vec3f d{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
      m.positions.push_back(
          d * (0.75f + 0.06f * std::sin(5 * d.x) * std::sin(4 * d.y + 1) + 0.05f * std::sin(6 * d.z)));
    }
  const auto at = [&](int i, int j) { return uint32_t(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i < n - 1) m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  // One vertex a pole.
  for (auto& t : m.triangles)
    for (uint32_t& v : t) {
      if (v < uint32_t(2 * n)) v = 0;
      if (v >= uint32_t(2 * n * n)) v = uint32_t(2 * n * n);
    }
  return m;
}

// Two bumpy balls close to one another: much of what one mirrors is the other.
inline Mesh two_bumpy_balls() {
  constexpr float kScale = 0.55f, kAway = 0.44f;
  const Mesh ball = bumpy_ball(28);
  Mesh m;
  for (const float side : {-1.0f, 1.0f}) {
    const auto first = uint32_t(m.positions.size());
    for (const Vec3f& p : ball.positions) m.positions.push_back(p * kScale + Vec3f{side * kAway, 0, 0});
    for (const auto& t : ball.triangles) m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return m;
}

inline Vec3f paint(Vec3f p) {
  const bool stripe = std::sin(9 * p.x + 4 * p.z) > 0;
  return stripe ? Vec3f{0.6f, 0.3f, 0.15f} : Vec3f{0.2f, 0.35f, 0.5f};
}

inline SgMixture studio() {
  return {{{normalize(Vec3f{1, 0.4f, 1}), 40, {6, 5.5f, 5}},
           {normalize(Vec3f{-1, 1, 0.3f}), 25, {2, 2.5f, 3}},
           {normalize(Vec3f{0.2f, -1, 0.5f}), 60, {4, 4, 4}},
           {{0, 0, 1}, 1.5f, {0.4f, 0.45f, 0.5f}},
           {{0, 0, -1}, 2, {0.2f, 0.18f, 0.15f}}}};
}

struct Drawn {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Transport> transport;
  std::vector<Vec3f> base;
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;
  std::vector<Vec3f> diffuse = {};  // the colors without reflections
  std::vector<Camera> cameras;
  std::vector<uint16_t> views;  // of the hits
  std::vector<uint8_t> clipped = {};
  SurfaceSamples samples() const { return {hits, colors, clipped}; }
};

using Materials = std::function<Material(Vec3f position)>;
using Colors = std::function<Vec3f(Vec3f position)>;

inline Camera looking_at_the_origin(Vec3f eye) {
  Camera camera;
  camera.center = to_double(eye);
  camera.world_from_cam = upright_rotation(to_double(-eye), {0, 0, 1});
  return camera;
}

// Adds hits of 40 views around the body, 800 rays each, and returns the albedo there.
inline std::vector<Vec3f> look_at(Drawn& d) {
  std::vector<Vec3f> origins, directions;
  for (int view = 0; view < 40; ++view) {
    const Vec3f eye = fibonacci_direction(view, 40) * 3.0f;
    d.cameras.push_back(looking_at_the_origin(eye));
    for (int k = 0; k < 800; ++k) {
      Rng rng(1, uint64_t(view), uint64_t(k));
      const Vec3f q = Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.4f;
      origins.push_back(eye);
      directions.push_back(normalize(q - eye));
    }
  }
  std::vector<Surface::RayHit> far(origins.size());
  d.surface->intersect(origins, directions, 0, far);
  const Mesh& m = d.surface->mesh();
  std::vector<Vec3f> albedo;
  for (size_t i = 0; i < far.size(); ++i) {
    if (far[i].t < 0) continue;
    const auto& t = m.triangles[far[i].triangle];
    const float b1 = far[i].b1, b2 = far[i].b2;
    const Vec3f n = normalize(at_corners(m.normals, t, b1, b2));
    d.views.push_back(uint16_t(i / 800));
    d.hits.push_back({origins[i] + directions[i] * far[i].t, n, -directions[i], far[i].triangle, b1, b2});
    albedo.push_back(at_corners(d.base, t, b1, b2));
  }
  return albedo;
}

// motion: how the light turns from view to view, about +Z.
inline Drawn draw(const Materials& material_at, const Colors& color_at,
                  LightMotion motion = LightMotion::world, Mesh body = bumpy_ball()) {
  Drawn d;
  d.surface = std::make_shared<const Surface>(std::move(body));
  d.transport = std::make_shared<Transport>(d.surface);
  const Mesh& m = d.surface->mesh();
  for (const Vec3f& p : m.positions) d.base.push_back(color_at(p));
  const std::vector<Vec3f> albedo = look_at(d);
  const Device device = make_device();
  std::vector<Material> of_vertices, of_hits;
  for (const Vec3f& p : m.positions) of_vertices.push_back(material_at(p));
  for (const Hit& h : d.hits) of_hits.push_back(material_at(h.position));
  const LightFrame frame = light_frame(motion, d.cameras, {0, 0, 1});
  for (size_t begin = 0, end; begin < d.hits.size(); begin = end) {
    for (end = begin; end < d.hits.size() && d.views[end] == d.views[begin];) ++end;
    const Mat3f room_from_object = frame.room_from_object(d.cameras[d.views[begin]].world_from_cam);
    const SgMixture light = rotated(studio(), transpose(room_from_object));
    const Lighting lighting(device, d.surface, light,
                            vertex_light(*d.transport, light, {d.base, of_vertices}));
    const Shading s = lighting.shade(HitBatch{d.hits, of_hits}.part(int(begin), int(end)),
                                     std::span(albedo).subspan(begin, end - begin));
    for (size_t i = 0; i < end - begin; ++i) d.colors.push_back(s.diffuse[i] + s.specular[i]);
    d.diffuse.insert(d.diffuse.end(), s.diffuse.begin(), s.diffuse.end());
  }
  return d;
}

inline Drawn draw(const Material& everywhere, float brightness = 1) {
  return draw([=](Vec3f) { return everywhere; }, [=](Vec3f p) { return paint(p) * brightness; });
}

inline LinearSplitOptions small() {
  LinearSplitOptions o;
  o.light_height = 32;
  o.search_height = 24;
  o.search_hits = 30000;
  return o;
}

// Vertices that enough samples saw.
inline std::vector<uint32_t> seen(const Drawn& d) {
  std::vector<int> count(d.base.size(), 0);
  for (const Hit& h : d.hits)
    for (const uint32_t v : d.surface->mesh().triangles[h.triangle]) ++count[v];
  std::vector<uint32_t> out;
  for (uint32_t v = 0; v < count.size(); ++v)
    if (count[v] >= 5) out.push_back(v);
  return out;
}
inline std::vector<Vec3f> pick(const std::vector<Vec3f>& values, const std::vector<uint32_t>& at) {
  std::vector<Vec3f> out;
  for (const uint32_t i : at) out.push_back(values[i]);
  return out;
}

// Least-squares factor from got to truth, and the relative error that remains.
struct Match {
  double scale, error;
};
inline Match match(const std::vector<Vec3f>& got, const std::vector<Vec3f>& truth) {
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    ab += dot(got[i], truth[i]);
    aa += dot(got[i], got[i]);
    bb += dot(truth[i], truth[i]);
  }
  return {ab / aa, std::sqrt(std::max(0.0, 1 - ab * ab / (aa * bb)))};
}

}  // namespace cei3d
