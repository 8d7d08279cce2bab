// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/joint_descent.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/pixel_points.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "model/geometry/shape/trace_field.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {
namespace {

constexpr float kBoxMargin = 0.1f;    // around the object, unit frame
constexpr float kNearSpread = 0.01f;  // standard deviation of points near the surface
constexpr size_t kMinJudged = 20000;  // held-out samples that judge the result, where there are so many
constexpr float kAlong = 1e-3f;       // step of differences along rays

// Keys of random numbers: what they choose.
enum : uint64_t { kSamples = 0x301a, kMask = 0x3a5c, kBox = 0xb0c5, kNear = 0x9ea2 };

FieldTrainer::Options sdf_rates(const JointOptions& o) {
  return {.encoding_rate = o.rates.sdf_tables, .network_rate = o.rates.sdf_layers, .adam = o.adam};
}

}  // namespace

JointDescent::JointDescent(const Device& device, const AppearanceInput& input, const PixelStore& pixels,
                           JointObject start, const JointOptions& options, const Progress& progress)
    : device_(device),
      input_(input),
      pixels_(pixels),
      options_(options),
      object_(std::move(start)),
      sdf_trainer_(object_.sdf, sdf_rates(options)),
      albedo_trainer_(object_.albedo, {.adam = options.adam}),
      material_(object_.material, options.rates.material, options.learn_specular, options.adam),
      light_(object_.light, options.keep_power, options.adam),
      box_min_{-1, -1, -1},
      box_max_{1, 1, 1} {
  object_.material = material_.field();
  object_.light = light_.light();  // rounded as after load()
  if (options.specular == SpecularTerm::single_sg) make_gloss();
  if (options.weight_norm) sdf_norm_.emplace(object_.sdf, options.rates.sdf_layers, options.adam);
  for (uint32_t i = 0; i < pixels.pixels().size(); ++i)
    if (pixels.pixels()[i].srgba[3] == 0) empty_.push_back(i);
  if (!input.surface) return;
  transport_.emplace(input.surface, std::vector<uint8_t>{}, progress);
  box_min_ = box_max_ = input.surface->mesh().positions.at(0);
  for (const Vec3f p : input.surface->mesh().positions)
    for (int c = 0; c < 3; ++c) {
      box_min_[c] = min(box_min_[c], p[c] - kBoxMargin);
      box_max_[c] = max(box_max_[c], p[c] + kBoxMargin);
    }
}

JointLoss JointDescent::step(int step, float rate) {
  if (!lighting_ || (input_.surface && step % options_.refresh == 0)) relight();
  Shaded shaded;
  const JointLoss loss = accumulate(step, shaded);
  update(shaded, rate);
  return loss;
}

void JointDescent::relight() {
  if (!input_.surface) {
    lighting_ = std::make_unique<Lighting>(device_, nullptr, object_.light, std::vector<VertexLight>{});
    return lighting_->use_hit_normals();
  }
  const std::vector<Vec3f>& vertices = input_.surface->mesh().positions;
  relit_ = RelitObject{object_.albedo.eval3(device_, vertices), object_.material.at(device_, vertices),
                       object_.light};
  light_up();
}

void JointDescent::light_up() {
  lighting_ = relit_->lighting(device_, input_.surface, *transport_, input_.samples.turned.turns);
  lighting_->use_hit_normals();
}

void JointDescent::make_gloss() {
  gloss_ = std::make_unique<SgShading>(
      device_, object_.gloss ? *object_.gloss : sg_material_of(object_.material.mean()),
      options_.rates.material, options_.adam);
  object_.gloss = gloss_->material();
  object_.material = nearest_material(*object_.gloss);
}

// Empty where the shading needs none.
std::vector<IncidentLight<float>> JointDescent::light_at(const HitBatch& batch) const {
  if (gloss_) return {};
  return input_.surface ? lighting_->incident_light(batch) : lighting_->unoccluded_light(batch);
}

std::vector<ShadingTerms<float>> JointDescent::terms_at(const HitBatch& batch,
                                                        const std::vector<IncidentLight<float>>& light) {
  return gloss_ ? gloss_->terms(object_.light, batch) : lighting_->terms(batch, light);
}

std::vector<uint32_t> JointDescent::choose_samples(int step) const {
  const auto all = uint32_t(input_.samples.hits.size());
  std::vector<uint32_t> out(static_cast<size_t>(options_.rays));
  for (size_t i = 0; i < out.size(); ++i) {
    out[i] = Rng(options_.seed ^ kSamples, uint64_t(step), i).below(all);
    if (out[i] % kHeldOutStride == 0) out[i] = std::min(out[i] + 1, all - 1);
  }
  return out;
}

JointLoss JointDescent::accumulate(int step, Shaded& shaded) {
  const std::vector<uint32_t> samples = choose_samples(step);
  std::vector<Hit> near;
  for (const uint32_t s : samples) near.push_back(input_.samples.hits[s]);
  const TracedHits traced(device_, object_.sdf, near, bool(input_.surface));
  JointLoss loss;
  ValueGrads by_values;
  loss.color = accumulate_color(traced, samples, shaded, by_values);
  loss.mask = accumulate_mask(step, traced.missed(), by_values);
  loss.eikonal = accumulate_eikonal(step, traced);
  const int outputs = object_.sdf.config().outputs;
  sdf_trainer_.accumulate(device_, by_values.points, [&](int begin, int end, const float*, float* d_out) {
    for (int i = begin; i < end; ++i) d_out[size_t(i - begin) * outputs] = by_values.d_values[size_t(i)];
  });
  return loss;
}

// Colors of the hits and their loss, and the gradients of all but the light's lobes.
double JointDescent::accumulate_color(const TracedHits& traced, const std::vector<uint32_t>& samples,
                                      Shaded& shaded, ValueGrads& by_values) {
  std::vector<uint32_t> seen;  // sample of each hit
  for (const uint32_t ray : traced.rays()) seen.push_back(samples[ray]);
  shaded.hits.assign(traced.hits().begin(), traced.hits().end());
  const std::vector<Vec3f> positions = positions_of(shaded.hits);
  // What the object hides from itself is known on the mesh, which the field may have left: rays begin there.
  for (size_t i = 0; i < seen.size() && input_.surface; ++i)
    shaded.hits[i].position = input_.samples.hits[seen[i]].position;
  shaded.materials = object_.material.at(device_, positions);
  shaded.views = views_of(input_.samples.turned, seen);
  const HitBatch batch = batch_of(shaded);
  const std::vector<IncidentLight<float>> light = light_at(batch);
  const std::vector<ShadingTerms<float>> terms = terms_at(batch, light);
  std::vector<float> footprints;
  std::vector<Vec3f> points;
  for (size_t i = 0; i < seen.size(); ++i) {
    footprints.push_back(input_.samples.footprints.empty() ? 0 : input_.samples.footprints[seen[i]]);
    for (const Vec3f p : pixel_points(traced.hits()[i], footprints[i])) points.push_back(p);
  }
  std::vector<Vec3f> colors(seen.size()), d_radiance(seen.size());
  std::vector<double> losses(seen.size(), 0);
  albedo_trainer_.accumulate(device_, points, [&](int begin, int end, const float* out, float* d_out) {
    for_each_pixel(begin, end, out, d_out, [&](int pixel, Vec3f a, Vec3f& d_a) {
      const auto i = size_t(pixel);
      losses[i] = color_loss(seen[i], terms[i].radiance(a), d_radiance[i]);
      colors[i] = a;
      d_a = d_radiance[i] * terms[i].gain();
    });
  });
  shaded.grads =
      gloss_ ? gloss_->grad(batch, colors, d_radiance) : lighting_->grad(batch, light, colors, d_radiance);
  if (!gloss_) material_.accumulate(device_, positions, shaded.grads.d_material);
  traced.backward(device_, depth_grads(traced, footprints, shaded.grads), shaded.grads.d_normal, by_values);
  return std::accumulate(losses.begin(), losses.end(), 0.0);
}

double JointDescent::color_loss(uint32_t sample, Vec3f radiance, Vec3f& d_radiance) const {
  const float weight = 1 / float(options_.rays);
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const float photo = input_.samples.colors[sample][c];
    const bool clipped = input_.samples.is_clipped(sample, c);
    const LossValue<float> loss = options_.color == ColorLoss::display
                                      ? display_loss(radiance[c], photo, clipped)
                                      : linear_loss(radiance[c], photo, clipped);
    sum += double(weight) * loss.value;
    d_radiance[c] = weight * loss.gradient;
  }
  return sum;
}

HitBatch JointDescent::batch_of(const Shaded& shaded) const {
  return {shaded.hits, shaded.materials, {input_.samples.turned.turns, shaded.views}};
}

// dL/d(depth) at constant normal: albedo and material change along the ray.
std::vector<float> JointDescent::depth_grads(const TracedHits& traced, std::span<const float> footprints,
                                             const ShadingGrads& grads) const {
  std::vector<Hit> before(traced.hits().begin(), traced.hits().end()), behind = before;
  const std::vector<Vec3f> first = traced.moved(-kAlong), last = traced.moved(kAlong);
  for (size_t i = 0; i < before.size(); ++i) before[i].position = first[i], behind[i].position = last[i];
  const std::vector<Vec3f> a = pixel_colors(device_, object_.albedo, before, footprints),
                           b = pixel_colors(device_, object_.albedo, behind, footprints);
  std::vector<float> out(before.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = dot(grads.d_albedo[i], b[i] - a[i]) / (2 * kAlong);
  if (!object_.material.varying()) return out;
  const std::vector<Material> m = object_.material.at(device_, first), n = object_.material.at(device_, last);
  for (size_t i = 0; i < out.size(); ++i) {
    const Material& d = grads.d_material[i];
    out[i] +=
        (d.roughness * (n[i].roughness - m[i].roughness) + d.metalness * (n[i].metalness - m[i].metalness)) /
        (2 * kAlong);
  }
  return out;
}

// Around the object within the rim of pixels that the store holds; without a surface, which may be anywhere
// at first, through any background pixel.
Ray JointDescent::empty_ray(int step, int i) const {
  constexpr int kTries = 64;
  Rng rng(options_.seed ^ kMask, uint64_t(step), uint64_t(i));
  for (int tries = 0; tries < kTries && !input_.surface; ++tries) {
    const uint32_t view = rng.below(uint32_t(pixels_.cameras().size()));
    const Camera& camera = pixels_.cameras()[view];
    const uint32_t x = rng.below(uint32_t(camera.width)), y = rng.below(uint32_t(camera.height));
    if (pixels_.masks()[view][size_t(y) * size_t(camera.width) + x] == kBackground)
      return camera.ray(float(x) + 0.5f, float(y) + 0.5f);
  }
  return pixels_.ray(pixels_.pixels()[empty_[rng.below(uint32_t(empty_.size()))]]);
}

// Rays around the object must not meet it; rays through it that missed must. Both at their nearest points.
double JointDescent::accumulate_mask(int step, const std::vector<Ray>& missed, ValueGrads& by_values) const {
  std::vector<Ray> rays;
  for (int i = 0; i < options_.mask_rays && !empty_.empty(); ++i) rays.push_back(empty_ray(step, i));
  const size_t empty = rays.size();
  rays.insert(rays.end(), missed.begin(), missed.end());
  const std::vector<FieldTrace> lowest = lowest_along(device_, object_.sdf, rays);
  const float sharpness = options_.mask_sharpness, weight = options_.mask * sharpness / float(options_.rays);
  double sum = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const LossValue<float> loss =
        i < empty ? empty_push(lowest[i].value, sharpness) : cover_pull(lowest[i].value, sharpness);
    sum += double(weight) * loss.value;
    by_values.points.push_back(rays[i].origin + rays[i].direction * lowest[i].depth);
    by_values.d_values.push_back(weight * loss.gradient);
  }
  return sum;
}

double JointDescent::accumulate_eikonal(int step, const TracedHits& traced) {
  std::vector<Vec3f> x;
  for (int i = 0; i < options_.box_points; ++i) {
    Rng rng(options_.seed ^ kBox, uint64_t(step), uint64_t(i));
    const Vec3f share{rng.uniform(), rng.uniform(), rng.uniform()};
    x.push_back(box_min_ + (box_max_ - box_min_) * share);
  }
  const std::span<const Hit> hits = traced.hits();
  for (int i = 0; i < options_.near_points && !hits.empty(); ++i) {
    Rng rng(options_.seed ^ kNear, uint64_t(step), uint64_t(i));
    const Hit& h = hits[rng.below(uint32_t(hits.size()))];
    x.push_back(h.position + h.normal * (kNearSpread * rng.normal()));
  }
  const float weight = options_.eikonal / float(std::max<size_t>(x.size(), 1));
  std::vector<double> losses(x.size());
  sdf_trainer_.accumulate_jets(device_, x, [&](int i, const FieldJet& jet) {
    const auto loss = eikonal(jet.gradient);
    losses[size_t(i)] = double(weight) * loss.value;
    return FieldJet{0, loss.gradient * weight};
  });
  return std::accumulate(losses.begin(), losses.end(), 0.0);
}

void JointDescent::update(const Shaded& shaded, float rate) {
  const JointRates& r = options_.rates;
  if (sdf_norm_)
    sdf_norm_->update(device_, sdf_trainer_, rate);
  else if (r.sdf_tables > 0 || r.sdf_layers > 0)
    sdf_trainer_.update(device_, rate);
  if (r.albedo > 0) albedo_trainer_.update(device_, r.albedo * rate);
  if (r.material > 0 && gloss_) {
    gloss_->update(rate);
    object_.gloss = gloss_->material();
    object_.material = nearest_material(*object_.gloss);
  } else if (r.material > 0) {
    material_.update(device_, rate);
    object_.material = material_.field();
  }
  if (r.light > 0) {
    if (gloss_)
      light_.step(device_, gloss_->lobes_grad(), r.light * rate);
    else
      light_.step(device_, batch_of(shaded), shaded.grads.d_sky_irradiance, shaded.grads.d_sky_reflection,
                  r.light * rate);
    object_.light = light_.light();
    if (!gloss_) lighting_->set_lobes(object_.light);
  }
}

double JointDescent::held_out_psnr() {
  if (!lighting_) relight();
  const size_t all = input_.samples.hits.size(), held = (all + kHeldOutStride - 1) / kHeldOutStride,
               stride = kHeldOutStride * std::max<size_t>(1, held / kMinJudged);
  std::vector<uint32_t> judged, seen;
  std::vector<Hit> near;
  for (size_t s = 0; s < all; s += stride)
    judged.push_back(uint32_t(s)), near.push_back(input_.samples.hits[s]);
  const TracedHits traced(device_, object_.sdf, near, bool(input_.surface));
  for (const uint32_t ray : traced.rays()) seen.push_back(judged[ray]);
  Shaded shaded;
  shaded.hits.assign(traced.hits().begin(), traced.hits().end());
  shaded.materials = object_.material.at(device_, positions_of(shaded.hits));
  shaded.views = views_of(input_.samples.turned, seen);
  std::vector<float> footprints;
  for (const uint32_t s : seen)
    footprints.push_back(input_.samples.footprints.empty() ? 0 : input_.samples.footprints[s]);
  const std::vector<Vec3f> albedo = pixel_colors(device_, object_.albedo, traced.hits(), footprints);
  const HitBatch batch = batch_of(shaded);
  const std::vector<ShadingTerms<float>> terms = terms_at(batch, light_at(batch));
  std::vector<Vec3f> radiance(judged.size(), Vec3f{0, 0, 0});
  for (size_t i = 0; i < seen.size(); ++i) radiance[traced.rays()[i]] = terms[i].radiance(albedo[i]);
  return display_psnr(input_.samples, judged, radiance);
}

void JointDescent::save(Tensors& out) const {
  object_.sdf.params().save(out, "sdf");
  sdf_trainer_.save(out, "sdf_adam");
  if (sdf_norm_) sdf_norm_->save(out, "sdf_norm");
  object_.albedo.params().save(out, "albedo");
  albedo_trainer_.save(out, "albedo_adam");
  material_.save(out, "material");
  light_.save(out, "light");
  if (gloss_) gloss_->save(out, "gloss");
  if (relit_) relit_->save(out);
}

void JointDescent::load(const Tensors& in) {
  object_.sdf.params().load(in, "sdf");
  sdf_trainer_.load(in, "sdf_adam");
  if (sdf_norm_) sdf_norm_->load(in, "sdf_norm");
  object_.albedo.params().load(in, "albedo");
  albedo_trainer_.load(in, "albedo_adam");
  material_.load(in, "material");
  object_.material = material_.field();
  if (gloss_) {
    gloss_->load(in, "gloss");
    object_.gloss = gloss_->material();
    object_.material = nearest_material(*object_.gloss);
  }
  light_.load(in, "light");
  object_.light = light_.light();
  lighting_ = nullptr;
  relit_.reset();
  if (!input_.surface || !RelitObject::is_in(in)) return;
  relit_ = RelitObject::load(in, input_.surface->mesh().positions.size(), object_.light.lobes.size());
  light_up();
  if (!gloss_) lighting_->set_lobes(object_.light);
}

}  // namespace cei3d
