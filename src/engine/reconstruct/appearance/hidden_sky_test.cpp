// SPDX-License-Identifier: Apache-2.0
// What is hidden of reflection lobes, against rays spread over them.
#include "engine/reconstruct/appearance/hidden_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/fibonacci.h"
#include "core/math/reflection.h"
#include "core/math/rng.h"
#include "core/math/tangents.h"
#include "engine/render/test_balls.h"

namespace cei3d {
namespace {

// Of lobes that are narrow beside the hemisphere, of which the rings are.
TEST(HiddenSky, RingsHoldTheEnergyOfTheLobe) {
  for (const float roughness : {0.1f, 0.2f, 0.3f, 0.4f}) {
    const HiddenRings energy = ring_energy(roughness);
    EXPECT_NEAR(std::accumulate(energy.begin(), energy.end(), 0.0f), 1, 1e-5f);
    const ReflectionLobe<float> lobe = reflection_lobe(roughness);
    constexpr int kDirections = 400000;
    double first = 0, all = 0;  // within the first two rings
    for (int i = 0; i < kDirections; ++i) {
      const float cosine = fibonacci_direction(i, kDirections).z;
      if (cosine < 0) continue;
      double density = 0;
      for (int j = 0; j < kReflectionLobes; ++j)
        density += double(lobe.weight[j]) * std::exp(double(lobe.lambda[j]) * (cosine - 1));
      all += density;
      if (cosine > std::cos(15 * kPi / 180)) first += density;
    }
    EXPECT_NEAR(energy[0] + energy[1], first / all, 6e-3) << roughness;
  }
}

Vec3f sg_direction(Vec3f axis, float lambda, Rng& rng) {
  const float cosine = 1 + std::log(1 - rng.uniform() * (1 - std::exp(-2 * lambda))) / lambda,
              sine = std::sqrt(max(1 - cosine * cosine, 0.0f)), turn = 2 * kPi * rng.uniform();
  const Tangents t = tangents_of(axis);
  return axis * cosine + (t.x * std::cos(turn) + t.y * std::sin(turn)) * sine;
}

// Share of the rays of a round lobe, of those above the horizon, that meet the surface.
float met_share(const Surface& surface, const Hit& hit, float roughness) {
  const ReflectionLobe<float> lobe = reflection_lobe(roughness);
  std::vector<Vec3f> origins, directions;
  for (uint64_t k = 0; k < 600; ++k) {
    Rng rng(5, 0, k);
    int j = 0;
    for (float u = rng.uniform(); j + 1 < kReflectionLobes && u > reflection_share(j); ++j)
      u -= reflection_share(j);
    const Vec3f d = sg_direction(mirror_direction(hit), lobe.lambda[j], rng);
    if (dot(d, hit.normal) < 0.05f) continue;
    origins.push_back(ray_origin(hit));
    directions.push_back(d);
  }
  std::vector<Surface::RayHit> met(origins.size());
  surface.intersect(origins, directions, 0, met);
  return float(std::count_if(met.begin(), met.end(), [](const Surface::RayHit& r) { return r.t >= 0; })) /
         float(met.size());
}

TEST(HiddenSky, TheShareIsThatOfRays) {
  const Surface surface(two_spheres(-0.32f));
  for (const float roughness : {0.2f, 0.4f}) {
    const HiddenRings energy = ring_energy(roughness);
    double bias = 0, error = 0;
    int partly = 0;
    for (const Hit& hit : some_hits(surface.mesh(), 1500)) {
      const Vec3f mirror = mirror_direction(hit);
      std::vector<Surface::RayHit> met(1);
      surface.intersect(std::vector{ray_origin(hit)}, std::vector{mirror}, 0, met);
      const uint32_t vertex = surface.mesh().triangles[hit.triangle][0];
      const HiddenSky hidden = hidden_sky(surface, vertex, hit.normal, mirror, met[0].t >= 0);
      const float got = hidden_share(hidden.rings, energy), want = met_share(surface, hit, roughness);
      if (got == 0 && want == 0) continue;
      ++partly;
      bias += got - want;
      error += std::abs(got - want);
    }
    ASSERT_GT(partly, 200);
    EXPECT_LT(std::abs(bias / partly), 0.01) << roughness;
    EXPECT_LT(error / partly, 0.03) << roughness;
  }
}

}  // namespace
}  // namespace cei3d
