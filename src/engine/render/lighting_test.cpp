// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lighting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/brdf.h"
#include "core/math/rng.h"
#include "engine/render/env_table.h"

namespace cei3d {
namespace {

void add_sphere(Mesh& m, Vec3f center, float radius, int n = 48) {
  const uint32_t first = uint32_t(m.positions.size());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float t = kPi * float(i) / float(n), p = kPi * float(j) / float(n);
      const Vec3f d{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
      m.positions.push_back(center + d * radius);
      m.normals.push_back(d);
    }
  const auto at = [&](int i, int j) { return first + uint32_t(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

// Hits in the middle of triangles, seen from random directions above them.
std::vector<Hit> some_hits(const Mesh& m, size_t n) {
  std::vector<Hit> hits;
  for (size_t i = 0; i < n; ++i) {
    Rng rng(3, 0, i);
    const uint32_t f = rng.below(uint32_t(m.triangles.size()));
    const auto& t = m.triangles[f];
    const Vec3f p = (m.positions[t[0]] + m.positions[t[1]] + m.positions[t[2]]) / 3.0f;
    const Vec3f normal = normalize(m.normals[t[0]] + m.normals[t[1]] + m.normals[t[2]]);
    Vec3f v = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    if (dot(v, normal) < 0) v = -v;
    hits.push_back({p, normal, normalize(v + normal * 0.3f), f, 1.0f / 3, 1.0f / 3});
  }
  return hits;
}

SgMixture uniform_sky() {
  return {{{{0, 0, 1}, kBroadestLobe, {1, 1, 1}}, {{0, 0, -1}, kBroadestLobe, {1, 1, 1}}}};
}

SgMixture some_sky() {
  SgMixture light;
  for (uint64_t k = 0; k < 20; ++k) {
    Rng rng(9, 0, k);
    light.lobes.push_back({normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}),
                           1 + 60 * rng.uniform(),
                           {rng.uniform(), rng.uniform(), rng.uniform()}});
  }
  return light;
}

TEST(Lighting, AConvexBodyUnderAUniformSkyReflectsItsAlbedoAndItsReflectance) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, 0}, 0.8f);
  const Surface surface(mesh);
  const Device device = make_device();
  const SgMixture sky = uniform_sky();
  const float level = radiance(sky, {1, 0, 0}).x;
  const std::vector<Vec3f> base(surface.mesh().positions.size(), Vec3f{0.5f, 0.5f, 0.5f});
  const auto hits = some_hits(surface.mesh(), 500);
  const std::vector<Vec3f> albedo(hits.size(), Vec3f{0.5f, 0.2f, 0.9f});
  const std::vector<Vec2f> table = env_brdf_table(0.3f);
  for (const float metalness : {0.0f, 1.0f}) {
    const Material material{0.3f, 0.5f, metalness};
    const Shading s = Lighting(device, surface, sky, base, material).shade(hits, albedo);
    for (size_t i = 0; i < hits.size(); ++i) {
      const float nv = dot(hits[i].normal, hits[i].to_camera);
      const Vec2f e = env_brdf_at(table, nv);
      EXPECT_NEAR(s.diffuse[i].y / level, (1 - metalness) * 0.2f, 0.01f);
      const float f0 = metalness * 0.9f + (1 - metalness) * 0.04f;
      if (nv > 0.35f) {
        EXPECT_NEAR(s.specular[i].z / level, f0 * e.x + e.y, 0.02f) << nv;
      }
      EXPECT_LE(s.specular[i].z, 1.01f * level);  // no energy out of nothing
    }
  }
}

TEST(Lighting, AHitDoesNotCareAboutItsNeighboursInTheBatch) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, -0.3f}, 0.5f);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f);
  const Surface surface(mesh);
  const Device device = make_device();
  const std::vector<Vec3f> base(surface.mesh().positions.size(), Vec3f{0.5f, 0.4f, 0.3f});
  const Lighting lighting(device, surface, some_sky(), base, {0.25f, 0.5f, 0.2f});
  const auto hits = some_hits(surface.mesh(), 5000);
  std::vector<Vec3f> albedo;
  for (size_t i = 0; i < hits.size(); ++i) albedo.push_back({Rng(1, 1, i).uniform(), 0.3f, 0.8f});
  const Shading all = lighting.shade(hits, albedo);
  for (const auto& [begin, end] : {std::pair{0, 1}, {7, 40}, {2040, 2060}, {33, 4999}}) {
    const auto part = lighting.shade(std::span(hits).subspan(begin, end - begin),
                                     std::span(albedo).subspan(begin, end - begin));
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(part.diffuse[i - begin][c], all.diffuse[i][c]);
        ASSERT_EQ(part.specular[i - begin][c], all.specular[i][c]);
      }
  }
}

TEST(Lighting, EveryHitIsShadedAsIfTheObjectWereOfItsMaterial) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, -0.3f}, 0.5f, 24);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f, 24);
  const Surface surface(mesh);
  const Device device = make_device();
  const auto transport = std::make_shared<const Transport>(surface);
  const std::vector<Vec3f> base(surface.mesh().positions.size(), Vec3f{0.5f, 0.4f, 0.3f});
  const auto hits = some_hits(surface.mesh(), 3000);
  Appearance look;
  look.materials = {{0.25f, 0.5f, 0.2f}, {0.6f, 0.5f, 0.2f}, {0.25f, 0.9f, 1}};
  for (size_t i = 0; i < hits.size(); ++i) {
    look.albedo.push_back({Rng(1, 1, i).uniform(), 0.3f, 0.8f});
    look.material.push_back(Rng(1, 2, i).below(3));
  }
  const Shading got =
      Lighting(device, surface, some_sky(), base, look.materials[0], transport).shade(hits, look);
  for (uint32_t m = 0; m < 3; ++m) {
    const Lighting alone(device, surface, some_sky(), base, look.materials[m], transport);
    const Shading expected = alone.shade(hits, look.albedo);
    for (size_t i = 0; i < hits.size(); ++i) {
      if (look.material[i] != m) continue;
      for (int c = 0; c < 3; ++c) {  // bit for bit: an edit of one part leaves the rest alone
        ASSERT_EQ(got.diffuse[i][c], expected.diffuse[i][c]);
        ASSERT_EQ(got.specular[i][c], expected.specular[i][c]);
      }
    }
  }
}

TEST(Lighting, IrradianceIsTheIntegralOverTheSkyThatIsSeen) {
  // Two spheres: brute-force integration with shadow rays, one bounce left out by a black surface.
  Mesh mesh;
  add_sphere(mesh, {0, 0, -0.35f}, 0.5f);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f);
  const Surface surface(mesh);
  const Device device = make_device();
  const SgMixture sky = some_sky();
  const std::vector<Vec3f> black(surface.mesh().positions.size(), Vec3f{0, 0, 0});
  const Lighting lighting(device, surface, sky, black, {0.3f, 0.5f, 0});
  const auto hits = some_hits(surface.mesh(), 60);
  const HitLight got = lighting.light_at(hits);
  double error = 0, total = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    std::vector<Vec3f> o, d;
    for (int k = 0; k < 6000; ++k) {
      const float z = 1 - (2 * float(k) + 1) / 6000, r = std::sqrt(1 - z * z), a = 2.39996323f * float(k);
      const Vec3f w{r * std::cos(a), r * std::sin(a), z};
      if (dot(w, hits[i].normal) <= 0) continue;
      o.push_back(hits[i].position + hits[i].normal * 2e-3f);
      d.push_back(w);
    }
    std::vector<Surface::RayHit> far(o.size());
    surface.intersect(o, d, 0, far);
    double truth = 0;
    for (size_t k = 0; k < d.size(); ++k)
      if (far[k].t < 0) truth += double(radiance(sky, d[k]).y) * dot(d[k], hits[i].normal) * 4 * M_PI / 6000;
    error += std::abs(truth - got.irradiance[i].y);
    total += truth;
  }
  EXPECT_LT(error / total, 0.04);
}

TEST(Transport, AWhiteCavityGlows) {
  // Inside the gap between two spheres, the bounce of a white surface replaces most of what it blocks.
  Mesh mesh;
  add_sphere(mesh, {0, 0, -0.4f}, 0.5f);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f);
  const Surface surface(mesh);
  const Transport transport(surface);
  const SkyRadiance sky(kSkyDirections, Vec3f{1, 1, 1});
  const auto seen = transport.sky(sky), open = transport.open_sky(sky);
  const std::vector<Vec3f> one(seen.size(), Vec3f{1, 1, 1});
  const auto bounce = transport.bounce(one);
  for (size_t v = 0; v < seen.size(); ++v) {
    EXPECT_NEAR(open[v].x, kPi, 0.02f);
    // What is not sky is surface, and a surface as bright as the sky closes the sum (up to the lift of the
    // rays).
    EXPECT_NEAR(seen[v].x + bounce[v].x, open[v].x, 0.12f);
  }
}

struct Path {
  Vec3f position, normal, to_camera, weight{1, 1, 1};
};

// Continues it in a random direction; false where it ends.
bool reflect(Path& path, Vec3f& out, Vec3f f0, float roughness, Rng& rng) {
  const float alpha = roughness * roughness, u = rng.uniform(), a = 2 * kPi * rng.uniform();
  const float c = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), r = std::sqrt(1 - c * c);
  const Vec3f n = path.normal, v = path.to_camera;
  const Vec3f x = normalize(cross(n, std::abs(n.x) > 0.9f ? Vec3f{0, 1, 0} : Vec3f{1, 0, 0})),
              y = cross(n, x);
  const Vec3f h = x * (r * std::cos(a)) + y * (r * std::sin(a)) + n * c;
  const float vh = dot(v, h), nv = dot(n, v);
  out = h * (2 * vh) - v;
  const float nl = dot(n, out);
  if (vh <= 0 || nl <= 0 || nv <= 0) return false;
  for (int k = 0; k < 3; ++k)
    path.weight[k] *= schlick(f0[k], vh) * smith_g1(nv, alpha) * smith_g1(nl, alpha) * vh / (c * nv);
  return true;
}

bool scatter(Path& path, Vec3f& out, Vec3f diffuse, Rng& rng) {
  out = normalize(path.normal + normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}));
  path.weight = path.weight * diffuse;
  return dot(out, path.normal) > 0;
}

// Brute force: the reflection at a point, GGX facets sampled, of paths of up to four bounces that may be
// diffuse after it.
Vec3f traced_reflection(const Surface& surface, const SgMixture& sky, const Hit& first, Vec3f f0,
                        Vec3f diffuse, float roughness, uint64_t key) {
  constexpr int kPaths = 3000;
  const bool both = dot(diffuse, diffuse) > 0;
  Vec3f sum{0, 0, 0};
  for (int s = 0; s < kPaths; ++s) {
    Rng rng(17, key, uint64_t(s));
    Path path{first.position, first.normal, first.to_camera};
    for (int bounce = 0; bounce < 4; ++bounce) {
      const bool choose = both && bounce > 0;
      if (choose) path.weight = path.weight * 2.0f;
      Vec3f l;
      if (!(choose && rng.uniform() < 0.5f ? scatter(path, l, diffuse, rng)
                                           : reflect(path, l, f0, roughness, rng)))
        break;
      const Vec3f from = path.position + path.normal * 2e-3f;
      Surface::RayHit far;
      surface.intersect(std::span(&from, 1), std::span(&l, 1), 0, std::span(&far, 1));
      if (far.t < 0) {
        sum += path.weight * radiance(sky, l);
        break;
      }
      const auto& t = surface.mesh().triangles[far.triangle];
      path.normal = normalize(at_corners(surface.mesh().normals, t, far.b1, far.b2));
      path.position = from + l * far.t;
      path.to_camera = -l;
    }
  }
  return sum / float(kPaths);
}

// Mean error, relative, of the reflections of two balls close to each other, where the other fills much of
// the lobe.
double error_between_balls(const Material& material, Vec3f color) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, -0.35f}, 0.5f);
  add_sphere(mesh, {0, 0, 0.5f}, 0.3f);
  const Surface surface(mesh);
  const Device device = make_device();
  const Lighting lighting(device, surface, some_sky(), std::vector<Vec3f>(mesh.positions.size(), color),
                          material);
  const auto hits = some_hits(surface.mesh(), 400);
  const HitLight light = lighting.light_at(hits);
  const Shading shading = lighting.shade(hits, std::vector<Vec3f>(hits.size(), color));
  const float dielectric = (1 - material.metalness) * kDielectricF0 * material.specular;
  const Vec3f f0 = color * material.metalness + Vec3f{dielectric, dielectric, dielectric};
  double error = 0, total = 0;
  int judged = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (light.open_mirror[i] > 0.7f || dot(hits[i].normal, hits[i].to_camera) < 0.4f) continue;
    const Vec3f truth = traced_reflection(surface, some_sky(), hits[i], f0, color * (1 - material.metalness),
                                          material.roughness, i);
    error += std::abs(shading.specular[i].y - truth.y);
    total += truth.y;
    ++judged;
  }
  EXPECT_GT(judged, 15);
  return error / total;
}

TEST(Lighting, AMetalMirrorsItself) {
  // Taken as diffuse, what it mirrors is off by 0.35.
  EXPECT_LT(error_between_balls({0.3f, 0.5f, 1}, {0.9f, 0.6f, 0.4f}), 0.2);
}

TEST(Lighting, ADielectricMirrorsItself) {
  EXPECT_LT(error_between_balls({0.3f, 0.5f, 0}, {0.6f, 0.4f, 0.3f}), 0.2);
}

// A convex body, so that nothing blocks a reflection.
TEST(Lighting, NormalSlopesEqualDifferencesOfTheShading) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, 0}, 0.7f);
  const Surface surface(mesh);
  const Device device = make_device();
  const size_t n = 40;
  const std::vector<Hit> hits = some_hits(surface.mesh(), n);
  std::vector<Vec3f> albedo(n), weight(n);
  for (size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      albedo[i][c] = Rng(1, i, uint64_t(c)).uniform();
      weight[i][c] = 2 * Rng(2, i, uint64_t(c)).uniform() - 1;
    }
  for (const float metalness : {0.0f, 1.0f}) {
    const Material material{0.35f, 0.5f, metalness};
    const Lighting lighting(device, surface, some_sky(),
                            std::vector<Vec3f>(mesh.positions.size(), {0.5f, 0.5f, 0.5f}), material);
    const std::vector<Vec3f> slopes = lighting.normal_slopes(hits, lighting.light_at(hits), albedo, weight);
    const auto sent = [&](size_t i, Vec3f normal) {
      Hit h = hits[i];
      h.normal = normalize(normal);
      const Shading s = lighting.shade(std::span(&h, 1), std::span(&albedo[i], 1));
      return double(dot(weight[i], s.diffuse[0] + s.specular[0]));
    };
    for (size_t i = 0; i < n; ++i) {
      const Vec3f t = normalize(cross(hits[i].normal, Vec3f{0.3f, 0.5f, 0.8f}));
      const float h = 0.004f;
      const double slope =
          (sent(i, hits[i].normal + t * h) - sent(i, hits[i].normal - t * h)) / (2 * double(h));
      EXPECT_NEAR(dot(slopes[i], t), slope, 0.03 * std::abs(slope) + 0.003) << i << ' ' << metalness;
    }
  }
}

}  // namespace
}  // namespace cei3d
