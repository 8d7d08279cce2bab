// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/appearance_descent.h"

#include <cmath>

#include "core/math/rng.h"
#include "engine/reconstruct/appearance/pixel_points.h"
#include "engine/reconstruct/appearance/sample_grad.h"

namespace cei3d {

namespace {

// Steps between two computations of visibility and bounces. With a turning light one takes many times as
// long.
constexpr int kRefresh = 25, kTurningRefresh = 100;

}  // namespace

AppearanceDescent::AppearanceDescent(const Device& device, const AppearanceInput& input,
                                     std::shared_ptr<const Transport> transport,
                                     const AppearanceOptions& options, Field albedo,
                                     const std::vector<Vec3f>& bouncing, AppearanceResult& result,
                                     Progress& progress)
    : device_(device),
      input_(input),
      transport_(std::move(transport)),
      options_(options),
      result_(result),
      progress_(progress),
      albedo_(std::move(albedo)),
      albedo_trainer_(albedo_, {.network_rate = options.network_rate}) {
  if (result.material.varying()) learn_materials(*result.material.varying());
  relit_.albedo = bouncing;
}

void AppearanceDescent::run(const DescentSchedule& schedule, const DescentStore& store) {
  if (store.from.tensors.empty())
    relight(std::move(relit_.albedo));
  else
    load(store.from, schedule);
  fit_albedo(schedule, store);
  refine(schedule, store);
}

// The radiance of a sample is linear in its albedo.
void AppearanceDescent::fit_albedo(const DescentSchedule& schedule, const DescentStore& store) {
  if (step_ >= schedule.albedo) return;
  const SurfaceSamples& samples = input_.samples;
  const std::vector<Material> materials = result_.material.at(device_, positions_of(samples.hits));
  const std::vector<ShadingTerms<float>> terms = lighting_->terms({samples.hits, materials, samples.turned});
  for (; step_ < schedule.albedo; ++step_) {
    const double u = double(step_) / schedule.albedo;
    between_steps(store, "albedo", 0.5 * u);
    choose_batch();
    std::vector<ShadingTerms<float>> of_batch;
    for (const uint32_t i : batch_) of_batch.push_back(terms[i]);
    albedo_trainer_.step(device_, points_, pixel_loss(of_batch),
                         schedule.albedo_rate * std::pow(0.1f, float(u)));
  }
}

// Visibility and bounces are recomputed now and then.
void AppearanceDescent::refine(const DescentSchedule& schedule, const DescentStore& store) {
  const int refresh = input_.samples.turned.turns ? kTurningRefresh : kRefresh;
  if (!light_) light_.emplace(result_.light, schedule.keep_power);
  for (; step_ < schedule.albedo + schedule.refine; ++step_) {
    const int64_t step = step_ - schedule.albedo;
    const double u = double(step) / schedule.refine;
    between_steps(store, "light and albedo", 0.5 + 0.5 * u);
    if (step % refresh == 0)
      relight(albedo_.eval3(device_, input_.surface->mesh().positions));
    else
      lighting_->set_lobes(result_.light);
    refine_step(std::pow(0.1f, float(u)), schedule.refine_albedo_rate);
  }
}

// done: of all steps, in [0, 1].
void AppearanceDescent::between_steps(const DescentStore& store, const char* what, double done) const {
  store.between_steps(progress_, [this] { return state(); });
  if (options_.show) options_.show(*lighting_, albedo_, result_.material);
  if (step_ % 50 == 0) progress_.report({what, done, -1, ""});
}

void AppearanceDescent::learn_materials(const Field& field) {
  materials_ = std::make_shared<Field>(field);
  result_.material = {result_.material.mean(), materials_};
  material_trainer_ = std::make_unique<FieldTrainer>(*materials_, FieldTrainer::Options{});
}

void AppearanceDescent::relight(std::vector<Vec3f> albedo) {
  relit_ = {std::move(albedo), result_.material.at(device_, input_.surface->mesh().positions), result_.light};
  light_up();
}

void AppearanceDescent::light_up() {
  lighting_ = relit_.lighting(device_, input_.surface, *transport_, input_.samples.turned.turns);
}

void AppearanceDescent::choose_batch() {
  batch_.resize(options_.batch);
  points_.clear();
  const SurfaceSamples& s = input_.samples;
  for (int i = 0; i < options_.batch; ++i) {
    batch_[i] = Rng(options_.seed, uint64_t(step_), uint64_t(i)).below(uint32_t(s.hits.size()));
    const float footprint = s.footprints.empty() ? 0 : s.footprints[batch_[i]];
    for (const Vec3f p : pixel_points(s.hits[batch_[i]], footprint)) points_.push_back(p);
  }
}

FieldTrainer::Loss AppearanceDescent::pixel_loss(const std::vector<ShadingTerms<float>>& terms) {
  pixel_albedo_.resize(batch_.size());
  d_radiance_.resize(batch_.size());
  return [this, &terms](int begin, int end, const float* out, float* d_out) {
    for_each_pixel(begin, end, out, d_out, [&](int i, Vec3f a, Vec3f& d_a) {
      const SampleGrad g = sample_grad(input_.samples, batch_[i], terms[i], a, 1 / float(batch_.size()));
      pixel_albedo_[i] = a;
      d_radiance_[i] = g.d_radiance;
      d_a = g.d_albedo;
    });
  };
}

void AppearanceDescent::refine_step(float rate, float albedo_rate) {
  choose_batch();
  std::vector<Hit> hits(options_.batch);
  for (int i = 0; i < options_.batch; ++i) hits[i] = input_.samples.hits[batch_[i]];
  const std::vector<uint16_t> views = views_of(input_.samples.turned, batch_);
  const std::vector<Vec3f> positions = positions_of(hits);
  const std::vector<Material> materials = result_.material.at(device_, positions);
  const HitBatch batch{hits, materials, {input_.samples.turned.turns, views}};
  const std::vector<IncidentLight<float>> light = lighting_->incident_light(batch);
  const std::vector<ShadingTerms<float>> terms = lighting_->terms(batch, light);
  albedo_trainer_.step(device_, points_, pixel_loss(terms), albedo_rate * rate);
  const ShadingGrads grads = lighting_->grad(batch, light, pixel_albedo_, d_radiance_);
  light_->step(device_, batch, grads.d_sky_irradiance, grads.d_sky_reflection, rate);
  result_.light = light_->light();
  if (materials_) material_trainer_->step(device_, positions, material_loss(grads.d_material), rate);
}

DescentState AppearanceDescent::state() const {
  DescentState s{step_, {}};
  albedo_.params().save(s.tensors, "albedo");
  albedo_trainer_.save(s.tensors, "albedo_adam");
  if (materials_) {
    materials_->params().save(s.tensors, "materials");
    material_trainer_->save(s.tensors, "materials_adam");
  }
  if (light_) light_->save(s.tensors, "light");
  relit_.save(s.tensors);
  return s;
}

void AppearanceDescent::load(const DescentState& s, const DescentSchedule& schedule) {
  step_ = s.step;
  albedo_.params().load(s.tensors, "albedo");
  albedo_trainer_.load(s.tensors, "albedo_adam");
  if (materials_) {
    materials_->params().load(s.tensors, "materials");
    material_trainer_->load(s.tensors, "materials_adam");
  }
  relit_ = RelitObject::load(s.tensors, input_.surface->mesh().positions.size(), result_.light.lobes.size());
  if (step_ >= schedule.albedo && s.tensors.contains("light/axes")) {
    light_.emplace(result_.light, schedule.keep_power);
    light_->load(s.tensors, "light");
    result_.light = light_->light();
  }
  light_up();
}

}  // namespace cei3d
