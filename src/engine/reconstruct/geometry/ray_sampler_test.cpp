// SPDX-License-Identifier: Apache-2.0
// The samples of rays through a ball against those chosen with the distance of every candidate known.
#include "engine/reconstruct/geometry/ray_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/rng.h"
#include "core/math/volume.h"
#include "engine/reconstruct/geometry/volume_renderer.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.5f;

GeometryOptions options_of_ball() {
  GeometryOptions o;
  o.sdf.outputs = 3;
  o.sdf.width = 8;
  o.sdf.activation = Activation::softplus;
  o.sdf.sphere_radius = kRadius;
  o.radiance_layers = 1;
  o.radiance_width = 8;
  return o;
}

struct Ball {
  GeometryOptions options = options_of_ball();
  Device device = make_device();
  Field sdf{options.sdf, 1};
  ParamSet radiance;
  OccupancyGrid grid{64};
  GeometrySchedule schedule = schedule_at(options, 0.1);
  std::vector<float> jitter;
  RayBatch batch;

  Ball() {
    for (Param& p : sdf.params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);  // the sphere alone
    add_mlp_params(radiance_config(options), radiance, 2);
    grid.refresh(device, sdf, 1e9f);
    std::vector<Ray> rays;
    for (int i = 0; i < kChunkRays; ++i) {
      Rng rng(5, 0, uint64_t(i));
      const auto uniform = [&] { return 2 * rng.uniform() - 1; };
      const Vec3f origin = normalize(Vec3f{uniform(), uniform(), uniform()}) * 3.0f;
      const Vec3f target = Vec3f{uniform(), uniform(), uniform()} * 0.6f;
      rays.push_back({origin, normalize(target - origin)});
      jitter.push_back(rng.uniform());
    }
    batch = view_rays(std::move(rays));
  }
  GeometryNetworks networks() const {
    return {.device = device,
            .sdf = sdf,
            .sdf_weights = {mlp_config(options.sdf), sdf.params()},
            .radiance_weights = {radiance_config(options), radiance},
            .levels = 0};
  }
  RaySamples samples(int* evaluated = nullptr) const {
    RaySampler sampler(options.sdf, options.sampling);
    RaySamples out;
    sampler.sample(networks(), schedule, grid, batch, jitter, out);
    if (evaluated) *evaluated = sampler.evaluated();
    return out;
  }
};

// Samples of one ray, from all of its candidates.
std::vector<float> brute_force(const Ball& ball, std::span<const float> depths, const Ray& ray, bool empty) {
  const float keep = ball.options.sampling.keep_weight, step = ball.schedule.step;
  std::vector<Vec3f> x;
  for (const float t : depths) x.push_back(ray.origin + ray.direction * t);
  const std::vector<float> f = first_output(ball.device, ball.sdf, x);
  std::vector<float> out;
  float light = 1;
  for (size_t i = 0; i < f.size() && (empty || light > keep); ++i) {
    const bool before = i > 0 && depths[i] - depths[i - 1] < 1.5f * step;
    const bool after = i + 1 < f.size() && depths[i + 1] - depths[i] < 1.5f * step;
    const float alpha = neus_alpha_of_neighbors<float>(
        {before ? f[i - 1] : 0, f[i], after ? f[i + 1] : 0, before, after}, step, ball.schedule.inv_s);
    if (light * alpha > keep || (empty && f[i] < 0)) out.push_back(depths[i]);
    light *= 1 - alpha;
  }
  return out;
}

// Returns how many candidates there are.
size_t expect_brute_force(const Ball& ball, const RaySamples& got) {
  std::vector<float> depths;
  std::vector<int> counts(ball.batch.rays.size());
  ball.grid.march(ball.batch.rays, {ball.schedule.step, ball.schedule.band, ball.schedule.slack}, ball.jitter,
                  depths, counts);
  size_t first = 0;
  for (size_t r = 0; r < counts.size(); ++r) {
    const std::vector<float> want = brute_force(ball, std::span(depths).subspan(first, size_t(counts[r])),
                                                ball.batch.rays[r], ball.batch.empty[r]);
    first += size_t(counts[r]);
    const std::vector<float> samples(got.depths.begin() + got.first[r],
                                     got.depths.begin() + got.first[r + 1]);
    EXPECT_EQ(samples, want) << "ray " << r;
  }
  return depths.size();
}

TEST(RaySampler, ChoosesTheSamplesThatKnowingEveryDistanceWouldAndComputesFewerDistances) {
  const Ball ball;
  int evaluated = 0;
  const RaySamples samples = ball.samples(&evaluated);
  EXPECT_LT(size_t(evaluated), expect_brute_force(ball, samples));
  EXPECT_GT(samples.count(), 2 * kChunkRays);
}

TEST(RaySampler, KeepsEveryCandidateInsideOnEmptyRays) {
  Ball ball;
  const int before = ball.samples().count();
  std::ranges::fill(ball.batch.empty, uint8_t(1));
  const RaySamples samples = ball.samples();
  expect_brute_force(ball, samples);
  EXPECT_GT(samples.count(), 1.1 * before);
}

TEST(VolumeRenderer, CoversWhereRaysMeetTheBallAndShowsTheBackgroundWhereTheyMiss) {
  Ball ball;
  const RaySamples samples = ball.samples();
  VolumeRenderer renderer(ball.options);
  renderer.forward(ball.networks(), ball.schedule, ball.batch, samples);
  int hits = 0, misses = 0;
  for (int r = 0; r < ball.batch.count(); ++r) {
    const Ray& ray = ball.batch.rays[r];
    const float closest = length(cross(ray.origin, ray.direction));
    if (closest < 0.9f * kRadius) {
      ++hits;
      EXPECT_GT(renderer.coverage()[r], 0.97f) << "ray " << r;
    }
    if (closest > 1.1f * kRadius) {
      ++misses;
      EXPECT_EQ(renderer.coverage()[r], 0);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(renderer.pixels()[r][c], 1);
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(misses, 1);
  for (int i = 0; i < samples.count(); ++i) {
    const Vec3f p = renderer.point(i), g = renderer.jets().gradient(i);
    EXPECT_NEAR(renderer.jets().value(i), length(p) - kRadius, 1e-6);
    EXPECT_NEAR(dot(g, p), length(p), 1e-5);
  }
}

}  // namespace
}  // namespace cei3d
