// SPDX-License-Identifier: Apache-2.0
// The program's shading against path tracing of the same ball, light and material, which shares with it
// nothing but the reflectance: neither the split-sum table, nor the lobes, nor the diffuse factor.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "engine/render/lighting.h"
#include "engine/render/sphere_scene.h"
#include "engine/synthetic/path_tracer.h"

namespace cei3d {
namespace {

constexpr int kHits = 400;
const Vec3f kColor{0.6f, 0.4f, 0.2f};

// In the middle of triangles, seen from above the horizon, with the ball's own normals.
std::vector<Hit> hits_of(const Mesh& mesh) {
  std::vector<Hit> hits;
  for (uint64_t i = 0; int(hits.size()) < kHits; ++i) {
    Rng rng(11, 0, i);
    const uint32_t f = rng.below(uint32_t(mesh.triangles.size()));
    const auto& t = mesh.triangles[f];
    const Vec3f n = normalize(at_corners(mesh.normals, t, 1.0f / 3, 1.0f / 3));
    const Vec3f v = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    if (dot(n, v) < 0.15f) continue;
    hits.push_back({n * kSphereRadius, n, v, f, 1.0f / 3, 1.0f / 3});
  }
  return hits;
}

// Mean absolute difference over the mean of the truth.
double error_of_shading(const Material& material, const std::string& light_name) {
  const Scene ball = sphere_scene();
  SyntheticScene truth;
  truth.shape = ball_shape(kSphereRadius);
  truth.finishes.assign(truth.shape.regions.size(), {material, kColor});
  truth.light = light_by_name(light_name);
  const PathTracer tracer(truth);
  const std::vector<Hit> hits = hits_of(ball.surface->mesh());
  const Device device = make_device();
  const std::vector<Vec3f> vertices(ball.surface->mesh().positions.size(), kColor);
  const Shading got = Lighting(device, ball.surface, truth.light, vertices, material)
                          .shade(UniformBatch(hits, material), std::vector<Vec3f>(hits.size(), kColor));
  double error = 0, total = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    Vec3f sum{0, 0, 0};
    for (uint32_t k = 0; k < 256; ++k) {
      SampleSequence samples(i, k);
      sum += tracer.radiance(body_point(truth, hits[i].position), hits[i].to_camera, samples) / 256.0f;
    }
    const Vec3f shaded = got.diffuse[i] + got.specular[i];
    for (int c = 0; c < 3; ++c) error += std::abs(double(shaded[c] - sum[c])), total += sum[c];
  }
  return error / total;
}

struct Bound {
  float roughness;
  double dielectric, metal;  // max error under any of the lights
};
// The rougher a metal, the farther its reflection is from a lobe of Gaussians.
constexpr Bound kBounds[] = {{0.2f, 0.022, 0.025}, {0.5f, 0.022, 0.075}, {0.8f, 0.022, 0.09}};

TEST(LightingTruth, ADielectricBallIsShadedAsPathTracingShowsIt) {
  for (const std::string& light : light_names())
    for (const Bound& b : kBounds)
      EXPECT_LT(error_of_shading({b.roughness, 0.5f, 0}, light), b.dielectric) << light << ' ' << b.roughness;
}

TEST(LightingTruth, AMetalBallIsShadedAsPathTracingShowsIt) {
  for (const std::string& light : light_names())
    for (const Bound& b : kBounds)
      EXPECT_LT(error_of_shading({b.roughness, 0.5f, 1}, light), b.metal) << light << ' ' << b.roughness;
}

}  // namespace
}  // namespace cei3d
