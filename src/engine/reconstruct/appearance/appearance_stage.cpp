// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/appearance_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/reflection.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/display_loss.h"
#include "engine/reconstruct/appearance/light_descent.h"
#include "engine/reconstruct/appearance/pixel_points.h"
#include "engine/render/lighting.h"
#include "model/light/fit.h"

namespace cei3d {

namespace {

LinearSplitOptions split_options(const AppearanceOptions& o, bool turning) {
  LinearSplitOptions s;
  s.seed = o.seed;
  s.fixed_roughness = o.roughness;
  s.light_color = o.light_color;
  if (o.effort == Effort::brief) {
    s.max_hits = 200000;
    s.search_hits = 120000;
    s.refinements = 2;
    s.light_height = 32;
  }
  if (o.effort == Effort::brief && turning) {  // each solve takes twice as long
    s.scan_step = 1.7f;
    s.refinements = 1;
  }
  return s;
}

constexpr float kAllMetal = 0.97f;  // mean metalness

bool all_metal(const MaterialField& material) { return material.mean().metalness > kAllMetal; }

// Steps of the joint descent (docs/notebook/0023).
int joint_steps_for(const MaterialField& material, bool brief) {
  if (all_metal(material)) return brief ? 120 : 400;
  return material.varying() ? (brief ? 60 : 600) : (brief ? 30 : 400);
}

// Rate of the albedo in the joint descent, of its full rates. Nothing but the albedo holds the light of
// metals: at full rates both wander.
float joint_albedo_rate(const MaterialField& material) { return all_metal(material) ? 0.1f : 1.0f; }

// Descent on the fields of albedo and material under a fixed light, then on all three. bouncing: initial
// albedo of the vertices for bounces, #V.
class Descent {
 public:
  Descent(const Device& device, const AppearanceInput& input, std::shared_ptr<const Transport> transport,
          const AppearanceOptions& options, Field albedo, const std::vector<Vec3f>& bouncing,
          AppearanceResult& result, Progress& progress)
      : device_(device),
        input_(input),
        transport_(std::move(transport)),
        options_(options),
        result_(result),
        progress_(progress),
        albedo_(std::move(albedo)),
        albedo_trainer_(albedo_, {.network_rate = options.network_rate}) {
    if (result.material.varying()) learn_materials(*result.material.varying());
    relight(bouncing);
  }

  // Descent on the albedo alone, from `rate` times the full rates down to a tenth. The radiance of a sample
  // is linear in its albedo.
  void fit_albedo(int steps, float rate) {
    const SurfaceSamples& samples = input_.samples;
    const std::vector<Material> materials = result_.material.at(device_, positions_of(samples.hits));
    const std::vector<ShadingTerms<float>> terms =
        lighting_->terms({samples.hits, materials, samples.turned});
    for (int step = 0; step < steps; ++step) {
      check_cancelled(progress_);
      choose_batch();
      const auto loss = [&](int begin, int end, const float* out, float* d_out) {
        for_each_pixel(begin, end, out, d_out, [&](int i, Vec3f a, Vec3f& d_a) {
          d_a = sample_grad(samples, batch_[i], terms[batch_[i]], a, 1 / float(options_.batch)).d_albedo;
        });
      };
      albedo_trainer_.step(device_, points_, loss, rate * std::pow(0.1f, float(step) / float(steps)));
      show();
      if (step % 50 == 0) progress_.report({"albedo", 0.5 * step / steps, -1, ""});
    }
  }

  // Descent on albedo, materials and light together; visibility and bounce are recomputed every kRefresh
  // steps.
  void fit_jointly(int steps, bool keep_power) {
    LightDescent light(result_.light, keep_power);
    for (int step = 0; step < steps; ++step) {
      check_cancelled(progress_);
      if (step % (input_.samples.turned.turns ? kTurningRefresh : kRefresh) == 0)
        relight(albedo_.eval3(device_, input_.surface->mesh().positions));
      else
        lighting_->set_lobes(result_.light);
      joint_step(light, std::pow(0.1f, float(step) / float(steps)));
      show();
      if (step % 50 == 0) progress_.report({"light and albedo", 0.5 + 0.5 * step / steps, -1, ""});
    }
  }

  Field take_albedo() { return std::move(albedo_); }

 private:
  // With a turning light a refresh takes many times as long.
  static constexpr int kRefresh = 25, kTurningRefresh = 100;

  void show() const {
    if (options_.show) options_.show(*lighting_, albedo_, result_.material);
  }

  void learn_materials(const Field& field) {
    materials_ = std::make_shared<Field>(field);
    result_.material = {result_.material.mean(), materials_};
    material_trainer_ = std::make_unique<FieldTrainer>(*materials_, FieldTrainer::Options{});
  }

  void relight(const std::vector<Vec3f>& albedo) {
    lighting_ = std::make_unique<Lighting>(
        device_, input_.surface, result_.light,
        turned_vertex_lights(*transport_, result_.light,
                             {albedo, result_.material.at(device_, input_.surface->mesh().positions)},
                             input_.samples.turned.turns));
  }

  void choose_batch() {
    batch_.resize(options_.batch);
    points_.clear();
    for (int i = 0; i < options_.batch; ++i) {
      batch_[i] =
          Rng(options_.seed, uint64_t(epoch_), uint64_t(i)).below(uint32_t(input_.samples.hits.size()));
      const SurfaceSamples& s = input_.samples;
      const float footprint = s.footprints.empty() ? 0 : s.footprints[batch_[i]];
      for (const Vec3f p : pixel_points(s.hits[batch_[i]], footprint)) points_.push_back(p);
    }
    ++epoch_;
  }

  void joint_step(LightDescent& descent, float rate) {
    choose_batch();
    std::vector<Hit> hits(options_.batch);
    for (int i = 0; i < options_.batch; ++i) hits[i] = input_.samples.hits[batch_[i]];
    const std::vector<uint16_t> views = views_of(input_.samples.turned, batch_);
    const std::vector<Vec3f> positions = positions_of(hits);
    const std::vector<Material> materials = result_.material.at(device_, positions);
    const HitBatch batch{hits, materials, {input_.samples.turned.turns, views}};
    const std::vector<IncidentLight<float>> light = lighting_->incident_light(batch);
    const std::vector<ShadingTerms<float>> terms = lighting_->terms(batch, light);
    std::vector<Vec3f> albedo(hits.size()), d_radiance(hits.size());
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for_each_pixel(begin, end, out, d_out, [&](int i, Vec3f a, Vec3f& d_a) {
        const SampleGrad g = sample_grad(input_.samples, batch_[i], terms[i], a, 1 / float(options_.batch));
        albedo[i] = a;
        d_radiance[i] = g.d_radiance;
        d_a = g.d_albedo;
      });
    };
    albedo_trainer_.step(device_, points_, loss, joint_albedo_rate(result_.material) * rate);
    const ShadingGrads slopes = lighting_->grad(batch, light, albedo, d_radiance);
    descent.step(device_, batch, slopes.d_sky_irradiance, slopes.d_sky_reflection, rate);
    result_.light = descent.light();
    if (materials_) descend_materials(positions, slopes.d_material, rate);
  }

  void descend_materials(const std::vector<Vec3f>& positions, const std::vector<Material>& d_material,
                         float rate) {
    constexpr int kOutputs = MaterialField::kOutputs;
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i)
        material_of_grad(out + kOutputs * (i - begin), d_material[size_t(i)], d_out + kOutputs * (i - begin));
    };
    material_trainer_->step(device_, positions, loss, rate);
  }

  const Device& device_;
  const AppearanceInput& input_;
  std::shared_ptr<const Transport> transport_;
  AppearanceOptions options_;
  AppearanceResult& result_;
  Progress& progress_;
  Field albedo_;
  FieldTrainer albedo_trainer_;
  std::shared_ptr<Field> materials_;  // null: one material, held constant
  std::unique_ptr<FieldTrainer> material_trainer_;
  std::unique_ptr<Lighting> lighting_;
  int epoch_ = 0;
  std::vector<uint32_t> batch_;
  std::vector<Vec3f> points_;  // kPixelPoints of each pixel
};

// Fits a field to the materials of the vertices, at the samples.
MaterialField fit_materials(const Device& device, const AppearanceInput& input,
                            const AppearanceOptions& options, const LinearSplit& split, Progress& progress) {
  if (split.materials.empty()) return split.material;
  constexpr int kOutputs = MaterialField::kOutputs;
  const auto field = std::make_shared<Field>(options.materials, options.seed + 200);
  FieldTrainer trainer(*field, {.network_rate = options.network_rate});
  const std::span<const Hit> hits = input.samples.hits;
  std::vector<Vec3f> points(size_t(options.batch));
  std::vector<float> targets(points.size() * kOutputs);
  for (int step = 0; step < options.material_steps; ++step) {
    check_cancelled(progress);
    for (size_t i = 0; i < points.size(); ++i) {
      const Hit& h = hits[Rng(options.seed ^ 0x3a7e, uint64_t(step), i).below(uint32_t(hits.size()))];
      points[i] = h.position;
      const auto& t = input.surface->mesh().triangles[h.triangle];
      outputs_for(material_at_corners(split.materials, t, h.b1, h.b2), &targets[kOutputs * i]);
    }
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = 0; i < (end - begin) * kOutputs; ++i)
        d_out[i] = (out[i] - targets[size_t(begin) * kOutputs + size_t(i)]) / float(options.batch);
    };
    trainer.step(device, points, loss, std::pow(0.03f, float(step) / float(options.material_steps)));
  }
  return {split.material, field};
}

}  // namespace

std::shared_ptr<const Transport> transport_of(const AppearanceInput& input, const Progress& progress) {
  if (input.transport) return input.transport;
  return std::make_shared<const Transport>(input.surface, std::vector<uint8_t>(), progress);
}

AppearanceResult separate_light(const Device& device, const AppearanceInput& input,
                                const AppearanceOptions& options, Progress& progress) {
  const double start = steady_seconds();
  AppearanceResult result;
  progress.report({"light", 0, -1, ""});
  result.split = linear_split(*transport_of(input, progress), input.samples,
                              split_options(options, input.samples.turned.turns != nullptr), progress);
  const Material& mean = result.split.material;
  progress.log(Json{{"stage", "linear split"},
                    {"seconds", steady_seconds() - start},
                    {"roughness", mean.roughness},
                    {"metalness", mean.metalness},
                    {"one_material", result.split.materials.empty()}}
                   .dump());
  progress.report({"lobes", 0.9, -1, ""});
  LobeFitOptions lobes;
  lobes.height = result.split.light.height;
  lobes.steps = options.lobe_steps;
  lobes.seen_through = 0.5f * reflection_scale(result.split.smoothest);
  result.light = fit_lobes(device, result.split.light, lobes, EnvUp::z, progress);
  result.material = fit_materials(device, input, options, result.split, progress);
  return result;
}

void descend_on_appearance(const Device& device, const AppearanceInput& input,
                           const AppearanceOptions& options, const std::vector<Vec3f>& vertex_albedo,
                           AppearanceResult& result, Progress& progress) {
  const double start = steady_seconds();
  const bool brief = options.effort == Effort::brief;
  Descent descent(device, input, transport_of(input, progress), options,
                  Field(options.albedo, options.seed + 100), vertex_albedo, result, progress);
  descent.fit_albedo(options.albedo_steps >= 0 ? options.albedo_steps : brief ? 300 : 800, 1);
  // The strength of the light is determined only by reflections of dielectrics.
  const bool keep_power = !all_metal(result.material);
  descent.fit_jointly(
      options.joint_steps >= 0 ? options.joint_steps : joint_steps_for(result.material, brief), keep_power);
  result.albedo = std::make_shared<const Field>(descent.take_albedo());
  progress.log(Json{{"stage", "descent"}, {"seconds", steady_seconds() - start}}.dump());
}

AppearanceResult fit_appearance(const Device& device, AppearanceInput input, const AppearanceOptions& options,
                                Progress& progress) {
  input.transport = transport_of(input, progress);
  AppearanceResult result = separate_light(device, input, options, progress);
  descend_on_appearance(device, input, options, std::vector<Vec3f>(result.split.albedo), result, progress);
  return result;
}

void refine_albedo(const Device& device, const AppearanceInput& input, const AppearanceOptions& options,
                   AppearanceResult& result, Progress& progress, int steps) {
  Descent descent(device, input, transport_of(input, progress), options, *result.albedo,
                  result.albedo->eval3(device, input.surface->mesh().positions), result, progress);
  descent.fit_albedo(steps, 0.2f);
  result.albedo = std::make_shared<const Field>(descent.take_albedo());
}

}  // namespace cei3d
