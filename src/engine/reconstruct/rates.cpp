// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/rates.h"

#include <algorithm>
#include <limits>

#include "core/base/cancel.h"
#include "core/base/json_reader.h"
#include "core/math/rng.h"
#include "core/math/scalar.h"
#include "engine/reconstruct/appearance/pixel_points.h"
#include "engine/reconstruct/surface_and_hits.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "model/field/sphere_start.h"
#include "model/geometry/shape/sky.h"
#include "model/scene/appearance.h"

namespace cei3d {

namespace {

constexpr int kSdfPoints = 2048;
constexpr int kLobes = 128;        // lobes of the light, as many as a fitted one has
constexpr int kMeshShare = 4;      // the measured mesh has 1/4 of the preset's cells per axis
constexpr size_t kHitShare = 100;  // 1/100 of the preset's hits are traced and shaded

// The shortest of several times: other programs only lengthen a measurement, and the first ones include
// memory allocation and cold caches. Work of milliseconds is repeated more often.
template <class Work>
double seconds_of(const Clock& clock, const Progress& progress, const Work& work) {
  constexpr int kLeast = 3, kMost = 30;
  constexpr double kEnough = 0.1;  // s
  double shortest = std::numeric_limits<double>::max(), spent = 0;
  for (int k = 0; k < kLeast || (k < kMost && spent < kEnough); ++k) {
    check_cancelled(progress);
    const double begin = clock();
    work();
    const double took = clock() - begin;
    shortest = std::min(shortest, took);
    spent += took;
  }
  return shortest;
}

std::vector<Vec3f> random_points(int n) {
  std::vector<Vec3f> x(n);
  for (int i = 0; i < n; ++i) {
    Rng rng(1, 0, uint64_t(i));
    x[i] = {2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
  }
  return x;
}

double step_seconds(const Device& device, const FieldConfig& config, int points, const Clock& clock,
                    const Progress& progress) {
  Field field(config, 1);
  FieldTrainer trainer(field, {});
  const std::vector<Vec3f> x = random_points(points);
  const auto loss = [&](int begin, int end, const float* out, float* d_out) {
    for (int k = 0; k < (end - begin) * config.outputs; ++k) d_out[k] = out[k] / float(points);
  };
  return seconds_of(clock, progress, [&] { trainer.step(device, x, loss); });
}

// About `count` rays through pixels spread evenly over the store.
std::vector<Ray> some_rays(const PixelStore& store, size_t count) {
  const size_t stride = std::max<size_t>(store.pixels().size() / std::max<size_t>(count, 1), 1);
  std::vector<Ray> rays;
  for (size_t i = 0; i < store.pixels().size(); i += stride) rays.push_back(store.ray(store.pixels()[i]));
  return rays;
}

SgMixture even_light() {
  SgMixture light;
  const auto& sky = sky_directions();
  for (int k = 0; k < kLobes; ++k)
    light.lobes.push_back({sky[k * sky.size() / kLobes], kLobes / 2.0f, {1, 1, 1}});
  return light;
}

// An untrained object: a sphere of radius 0.5 in even light.
Scene untrained_scene(const Device& device, const Preset& preset) {
  Scene scene;
  Field sdf(preset.geometry.sdf, 1);
  begin_as_sphere(device, sdf, preset.start_radius, 1);
  scene.sdf = std::make_shared<const Field>(std::move(sdf));
  scene.albedo = std::make_shared<const Field>(preset.appearance.albedo, 1);
  scene.light = even_light();
  return scene;
}

}  // namespace

Json to_json(const Rates& r) {
  return {{"sdf_step", r.sdf_step}, {"trial_step", r.trial_step}, {"albedo_step", r.albedo_step},
          {"mesh", r.mesh},         {"hit_traced", r.hit_traced}, {"hit_shaded", r.hit_shaded}};
}

Rates rates_from_json(const Json& j) {
  JsonReader reader(j, "The rates in the checkpoint");
  const auto seconds = [&](const char* name) { return reader.require<double>(name); };
  const Rates rates{.sdf_step = seconds("sdf_step"),
                    .trial_step = seconds("trial_step"),
                    .albedo_step = seconds("albedo_step"),
                    .mesh = seconds("mesh"),
                    .hit_traced = seconds("hit_traced"),
                    .hit_shaded = seconds("hit_shaded")};
  reader.finish();
  return rates;
}

Rates measure_rates(const Device& device, const Preset& preset, const PixelStore& pixels, const Clock& clock,
                    const Progress& progress) {
  const auto step = [&](const FieldConfig& config, int points) {
    return step_seconds(device, config, points, clock, progress);
  };
  Rates r;
  r.sdf_step = step(preset.geometry.sdf, kSdfPoints);
  r.trial_step = step(preset.trial.geometry.sdf, kSdfPoints);
  r.albedo_step = step(preset.appearance.albedo, preset.appearance.batch * kPixelPoints);

  Scene scene = untrained_scene(device, preset);
  const MeshingOptions meshing{std::max(preset.meshing.resolution / kMeshShare / 4 * 4, 16)};
  const double mesh = seconds_of(
      clock, progress, [&] { scene.surface = extract_surface(device, *scene.sdf, meshing, progress); });
  r.mesh = mesh / square(double(meshing.resolution));

  const std::vector<Ray> rays = some_rays(pixels, preset.max_hits / kHitShare);
  std::vector<Hit> hits;
  std::vector<uint32_t> ray_of_hit;
  const double tracing = seconds_of(
      clock, progress, [&] { hits = trace_rays(device, *scene.sdf, *scene.surface, rays, ray_of_hit); });
  r.hit_traced = tracing / double(std::max<size_t>(hits.size(), 1));
  const SceneLight light(device, scene, scene_transports(scene));
  const double shading =
      seconds_of(clock, progress, [&] { light.shade(hits, appearance_at(device, scene, hits)); });
  r.hit_shaded = shading / double(std::max<size_t>(hits.size(), 1));
  return r;
}

}  // namespace cei3d
