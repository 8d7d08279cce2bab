// SPDX-License-Identifier: Apache-2.0
// Reflections of a surface in itself, against brute-force path tracing.
#include "engine/render/self_reflection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math/brdf.h"
#include "core/math/rng.h"
#include "engine/render/lighting.h"
#include "engine/render/test_balls.h"

namespace cei3d {
namespace {

struct Path {
  Vec3f position, normal, to_camera, weight{1, 1, 1};
};

// Continues it in a random direction; false where it ends.
bool reflect(Path& path, Vec3f& out, Vec3f f0, float f90, float roughness, Rng& rng) {
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
    path.weight[k] *= f90 * fresnel(f0[k] / max(f90, 1e-6f), vh) * smith_g1(nv, alpha) * smith_g1(nl, alpha) *
                      vh / (c * nv);
  return true;
}

bool scatter(Path& path, Vec3f& out, Vec3f diffuse, Rng& rng) {
  out = normalize(path.normal + normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}));
  path.weight = path.weight * diffuse;
  return dot(out, path.normal) > 0;
}

float mean_of(Vec3f v) { return (v.x + v.y + v.z) / 3; }

using MadeOfAt = std::function<MadeOf(Vec3f)>;

// Brute force: the reflection at a point, GGX facets sampled, of paths of up to four bounces that may be
// diffuse after it.
Vec3f traced_reflection(const Surface& surface, const SgMixture& sky, const Hit& first,
                        const MadeOfAt& made_of, uint64_t key) {
  constexpr int kPaths = 3000;
  Vec3f sum{0, 0, 0};
  for (int s = 0; s < kPaths; ++s) {
    Rng rng(17, key, uint64_t(s));
    Path path{first.position, first.normal, first.to_camera};
    for (int bounce = 0; bounce < 4; ++bounce) {
      const auto [albedo, material] = made_of(path.position);
      const float m = material.metalness;
      const Vec3f f0 = f0_of(albedo, material.specular, m), diffuse = albedo * (1 - m);
      const bool choose = m < 1 && bounce > 0;
      if (choose) path.weight = path.weight * 2.0f;
      Vec3f l;
      if (!(choose && rng.uniform() < 0.5f
                ? scatter(path, l, diffuse, rng)
                : reflect(path, l, f0, f90_of(material.specular, m), material.roughness, rng)))
        break;
      const Vec3f from = path.position + path.normal * kRayLift;
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

// Mean error, relative, of the reflections of two balls close to each other, where the other one fills
// `blocked` of the lobe or more.
double error_between_balls(const MadeOf& lower, const MadeOf& upper, const SgMixture& sky = some_sky(),
                           float blocked = 0.3f, size_t count = 400) {
  const Mesh mesh = two_spheres(-0.35f);
  const auto made_of = [&](Vec3f p) { return p.z < 0.175f ? lower : upper; };
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  VertexMaterials vertices;
  for (const Vec3f p : mesh.positions) {
    vertices.albedo.push_back(made_of(p).albedo);
    vertices.material.push_back(made_of(p).material);
  }
  const Lighting lighting(device, surface, sky, vertex_light(Transport(surface), sky, vertices));
  const auto hits = some_hits(surface->mesh(), count);
  std::vector<Material> materials;
  std::vector<Vec3f> albedo;
  for (const Hit& h : hits) {
    albedo.push_back(made_of(h.position).albedo);
    materials.push_back(made_of(h.position).material);
  }
  const std::vector<IncidentLight<float>> light = lighting.incident_light({hits, materials});
  const Shading shading = lighting.shade({hits, materials}, albedo);
  double error = 0, total = 0;
  int judged = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (mean_of(light[i].mirror_visibility) > 1 - blocked || dot(hits[i].normal, hits[i].to_camera) < 0.4f)
      continue;
    const Vec3f truth = traced_reflection(*surface, sky, hits[i], made_of, i);
    error += std::abs(shading.specular[i].y - truth.y);
    total += truth.y;
    ++judged;
  }
  EXPECT_GT(judged, 15);
  return error / total;
}

TEST(SelfReflection, AMetalReflectsItself) {
  EXPECT_LT(error_between_balls(kCopper, kCopper), 0.2);  // .35 if what it reflects were taken to be diffuse
}

TEST(SelfReflection, ADielectricReflectsItself) { EXPECT_LT(error_between_balls(kClay, kClay), 0.2); }

TEST(SelfReflection, AMetalReflectsADielectricAsADielectric) {
  EXPECT_LT(error_between_balls(kCopper, kGreenPaint), 0.2);
}

// A lamp is hidden as a whole or not at all, whatever part of a lobe is.
TEST(SelfReflection, ALampIsHiddenWhereTheObjectIsInFrontOfIt) {
  SgMixture lamps;
  for (uint64_t k = 0; k < 12; ++k) {
    Rng rng(21, 0, k);
    lamps.lobes.push_back({normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}), 40, {1, 1, 1}});
  }
  MadeOf copper = kCopper;
  copper.material.roughness = 0.2f;
  const MadeOf black{{0, 0, 0}, {0.9f, 0, 0}};
  // .41 by the share of the lobe that is blocked
  EXPECT_LT(error_between_balls(copper, black, lamps, 0.02f, 1600), 0.15);
}

}  // namespace
}  // namespace cei3d
