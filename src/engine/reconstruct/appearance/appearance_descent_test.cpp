// SPDX-License-Identifier: Apache-2.0
// The gradient of the albedo's loss, for every tensor of its network, against differences of the loss of the
// same pixels.
#include "engine/reconstruct/appearance/appearance_descent.h"

#include <gtest/gtest.h>

#include "core/math/loss.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "engine/reconstruct/test_directions.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {

struct AppearanceDescentProbe {
  static void choose_batch(AppearanceDescent& d) {
    d.relight(d.relit_.albedo);
    d.choose_batch();
  }
  static std::vector<Hit> hits(const AppearanceDescent& d) {
    std::vector<Hit> out;
    for (const uint32_t i : d.batch_) out.push_back(d.input_.samples.hits[i]);
    return out;
  }
  static std::vector<ShadingTerms<float>> terms(const AppearanceDescent& d) {
    const std::vector<Hit> batch = hits(d);
    const std::vector<Material> materials = d.result_.material.at(d.device_, positions_of(batch));
    return d.lighting_->terms({batch, materials});
  }
  static void accumulate(AppearanceDescent& d, const std::vector<ShadingTerms<float>>& terms) {
    d.albedo_trainer_.accumulate(d.device_, d.points_, d.pixel_loss(terms));
  }
  static Field& albedo(AppearanceDescent& d) { return d.albedo_; }
  static std::span<const float> gradient(const AppearanceDescent& d, const Param& p) {
    return d.albedo_trainer_.gradient(p);
  }
};

namespace {

using Probe = AppearanceDescentProbe;
constexpr float kFootprint = 0.05f,
                kPhoto = 2;  // brighter than all pixels, so that their slopes do not cancel

// No grid, so that nothing has kinks.
Field smooth_colors() {
  FieldConfig c;
  c.encoding.frequencies = 3;
  c.width = 16;
  c.activation = Activation::softplus;
  c.softplus_beta = 10;
  c.output_activation = Activation::sigmoid;
  return Field(c, 6);
}

// Loss of the shaded mean albedo of the points of each pixel.
double loss(const Device& device, const Field& albedo, const std::vector<Hit>& hits,
            const std::vector<ShadingTerms<float>>& terms) {
  const std::vector<float> footprints(hits.size(), kFootprint);
  const std::vector<Vec3f> colors = pixel_colors(device, albedo, hits, footprints);
  double sum = 0;
  for (size_t i = 0; i < hits.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += display_loss(terms[i].radiance(colors[i])[c], kPhoto).value;
  return sum / double(hits.size());
}

TEST(AppearanceDescent, GradientOfTheAlbedoEqualsDifferencesOfTheLoss) {
  const Device device = make_device();
  const Scene scene = sphere_scene();
  const std::vector<Hit> hits = trace_view(device, scene, camera_towards_origin({2, -2, 1}, 64), 1).hits;
  const std::vector<Vec3f> photo(hits.size(), Vec3f{kPhoto, kPhoto, kPhoto});
  const std::vector<float> footprints(hits.size(), kFootprint);
  const AppearanceInput input{scene.surface, {hits, photo, {}, footprints}};
  AppearanceOptions options;
  options.batch = 512;
  AppearanceResult result;
  result.light = scene.light;
  result.material = Material{0.4f, 0.5f, 0.3f};
  Progress quiet;
  AppearanceDescent descent(device, input, std::make_shared<const Transport>(scene.surface), options,
                            smooth_colors(), std::vector<Vec3f>(scene.surface->mesh().positions.size()),
                            result, quiet);
  Probe::choose_batch(descent);
  const std::vector<Hit> batch = Probe::hits(descent);
  const std::vector<ShadingTerms<float>> terms = Probe::terms(descent);
  Probe::accumulate(descent, terms);
  Field& albedo = Probe::albedo(descent);
  for (Param& p : albedo.params().all()) {
    constexpr float kStep = 5e-3f;
    const TensorDirection direction(Probe::gradient(descent, p).first(p.count()), 0);
    const std::vector<float> before = p.value;
    const auto loss_at = [&](float h) {
      for (size_t i = 0; i < direction.of.size(); ++i) p.value[i] = before[i] + h * direction.of[i];
      return loss(device, albedo, batch, terms);
    };
    const double want = (loss_at(kStep) - loss_at(-kStep)) / (2 * double(kStep));
    p.value = before;
    EXPECT_GT(std::abs(want), 1e-3) << p.name;
    EXPECT_NEAR(direction.slope, want, 0.02 * std::abs(want) + 1e-4) << p.name;
  }
}

}  // namespace
}  // namespace cei3d
