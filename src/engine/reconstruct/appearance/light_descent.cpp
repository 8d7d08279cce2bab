// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_descent.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/compute/kernels/shade.h"
#include "core/compute/planes.h"
#include "engine/render/hit_reflection.h"
#include "engine/render/lobe_frames.h"

namespace cei3d {
namespace {

constexpr int kGrain = 512;                           // hits per chunk
constexpr float kLogRate = 1e-2f, kAxisRate = 2e-3f;  // of Adam, on logarithms and on unit vectors
constexpr float kDarkest = 1e-5f;                     // minimum peak radiance; logarithms of 0 do not exist

// Inputs of the lobes' gradient for the hits and one part of their reflection, as planes.
struct HitPlanes {
  LobeFrames lobes;
  std::vector<float> normals, reflection_lobes, d_irradiance, d_reflected;
};

HitPlanes hit_planes(const Device& device, const HitBatch& batch, ReflectionPart part,
                     std::span<const Vec3f> d_irradiance, std::span<const Vec3f> d_reflected) {
  const int stride = padded_to_panels(int(batch.size()));
  const bool base = part == ReflectionPart::base;
  HitPlanes p{LobeFrames(stride), {}, {}, {}, {}};
  std::vector<Vec3f> normals, d_lobe;
  for (size_t i = 0; i < batch.size(); ++i) {
    const SurfaceReflection<float> r = reflection_of(batch.hits[i], batch.materials[i]);
    normals.push_back(batch.turned.in_room(i, batch.hits[i].normal));
    p.lobes.put(i, in_room(batch.turned, i, base ? r.base : r.fresnel));
    d_lobe.push_back(d_reflected[i] * (base ? r.share : 1 - r.share));
  }
  p.normals = planes_of(normals, stride);
  p.d_irradiance = base ? planes_of(d_irradiance, stride) : planes_of({}, stride);
  p.d_reflected = planes_of(d_lobe, stride);
  p.reflection_lobes.resize(size_t(ReflectionLobes::kRows) * stride);
  const ReflectionPlanes lobes = p.lobes.planes();
  device.launch<ReflectionLobes>({stride, lobes.roughness, lobes.stretch, p.reflection_lobes.data()}, stride);
  return p;
}

// Adds to sum.
void add_lobes_grad(const Device& device, const LobePlanes& lobes, int n, const HitPlanes& hits,
                    std::vector<float>& sum) {
  const int chunks = (n + kGrain - 1) / kGrain;
  std::vector<std::vector<float>> parts(size_t(chunks), std::vector<float>(sum.size(), 0.0f));
  parallel_for(chunks, [&](int c) {
    device.launch<SgLobesGrad>({.lobes = lobes,
                                .stride = hits.lobes.stride(),
                                .begin = c * kGrain,
                                .end = min(n, (c + 1) * kGrain),
                                .normals = hits.normals.data(),
                                .axes = hits.lobes.planes().axes,
                                .across = hits.lobes.planes().across,
                                .reflection_lobes = hits.reflection_lobes.data(),
                                .d_irradiance = hits.d_irradiance.data(),
                                .d_reflected = hits.d_reflected.data(),
                                .d_lobes = parts[size_t(c)].data()},
                               lobes.padded);
  });
  for (const std::vector<float>& part : parts)
    for (size_t i = 0; i < part.size(); ++i) sum[i] += part[i];
}

}  // namespace

std::vector<float> lobes_grad(const Device& device, const LobePlanes& lobes, const HitBatch& batch,
                              std::span<const Vec3f> d_irradiance, std::span<const Vec3f> d_reflected) {
  std::vector<float> sum(size_t(7) * lobes.padded, 0.0f);
  for (const ReflectionPart part : {ReflectionPart::base, ReflectionPart::fresnel})
    add_lobes_grad(device, lobes, int(batch.size()),
                   hit_planes(device, batch, part, d_irradiance, d_reflected), sum);
  return sum;
}

LightDescent::LightDescent(const SgMixture& light, bool keep_power, AdamConstants adam)
    : count_(int(light.lobes.size())),
      padded_(padded_to_panels(int(light.lobes.size()))),
      keep_power_(keep_power) {
  params_.add("axes", {3, padded_});
  params_.add("logs", {4, padded_});
  axes_ = &params_.get("axes");
  logs_ = &params_.get("logs");
  optimizer_.add(params_, "axes", {.rate = kAxisRate, .adam = adam});
  optimizer_.add(params_, "logs", {.rate = kLogRate, .adam = adam});
  for (int k = 0; k < count_; ++k) {
    const SgLobe& l = light.lobes[size_t(k)];
    store_planes(axes_->value.data(), padded_, k, l.axis);
    logs_->value[size_t(k)] = std::log(l.lambda);
    for (int c = 0; c < 3; ++c)
      logs_->value[size_t(1 + c) * padded_ + k] = std::log(max(l.mu[c], kDarkest) * sg_integral(l.lambda));
  }
  first_power_ = total_power();
}

Vec3f LightDescent::power_of(int k) const {
  const float* row = logs_->value.data() + padded_ + k;
  return {std::exp(row[0]), std::exp(row[padded_]), std::exp(row[2 * padded_])};
}

Vec3f LightDescent::total_power() const {
  Vec3f sum{0, 0, 0};
  for (int k = 0; k < count_; ++k) sum += power_of(k);
  return sum;
}

// [7][padded]; the padding's color is black.
std::vector<float> LightDescent::lobe_planes() const {
  std::vector<float> p(axes_->value);
  p.resize(size_t(7) * padded_, 0.0f);
  for (int k = 0; k < count_; ++k) {
    const float lambda = std::exp(logs_->value[size_t(k)]);
    p[size_t(3) * padded_ + k] = lambda;
    store_planes(p.data() + size_t(4) * padded_, padded_, k, power_of(k) / sg_integral(lambda));
  }
  return p;
}

SgMixture LightDescent::light() const {
  const std::vector<float> p = lobe_planes();
  const LobePlanes lobes{p.data(), count_, padded_};
  SgMixture out;
  for (int k = 0; k < count_; ++k)
    out.lobes.push_back({lobes.axis<float>(k), lobes.lambda<float>(k), lobes.mu<float>(k)});
  return out;
}

void LightDescent::save(Tensors& out, const std::string& prefix) const {
  params_.save(out, prefix);
  optimizer_.save(out, prefix + "/adam");
  out[prefix + "/first_power"] = {{3}, {first_power_.x, first_power_.y, first_power_.z}, {}};
}

void LightDescent::load(const Tensors& in, const std::string& prefix) {
  params_.load(in, prefix);
  optimizer_.load(in, prefix + "/adam");
  const std::vector<float>& power = require_tensor(in, prefix + "/first_power", {3}).f32;
  first_power_ = {power[0], power[1], power[2]};
}

// Axes: along the sphere. Sharpness: at constant power, so that the peak color follows it.
void LightDescent::set_gradient(const std::vector<float>& lobes, const std::vector<float>& d_lobes) {
  const std::span<float> d_axes = optimizer_.gradient(*axes_), d_logs = optimizer_.gradient(*logs_);
  Vec3f d_common{0, 0, 0};  // by a factor that all lobes share
  for (int k = 0; k < count_; ++k) {
    const LobePlanes at{lobes.data(), count_, padded_}, d_at{d_lobes.data(), count_, padded_};
    const Vec3f axis = at.axis<float>(k), d_axis = d_at.axis<float>(k),
                d_power = d_at.mu<float>(k) * at.mu<float>(k);
    const float lambda = at.lambda<float>(k), mean = d_power.x + d_power.y + d_power.z;
    store_planes(d_axes.data(), padded_, k, d_axis - axis * dot(d_axis, axis));
    d_logs[size_t(k)] =
        lambda * (d_at.lambda<float>(k) - mean * sg_integral_grad(lambda) / sg_integral(lambda));
    store_planes(d_logs.data() + padded_, padded_, k, d_power);
    d_common += d_power;
  }
  if (!keep_power_) return;
  const Vec3f total = total_power();
  for (int k = 0; k < count_; ++k) {
    float* d_power = d_logs.data() + padded_;
    store_planes(d_power, padded_, k,
                 load_planes<float>(d_power, padded_, k) - d_common * power_of(k) / total);
  }
}

void LightDescent::normalize_lobes() {
  for (int k = 0; k < count_; ++k) {
    store_planes(axes_->value.data(), padded_, k,
                 normalize(load_planes<float>(axes_->value.data(), padded_, k)));
    logs_->value[size_t(k)] =
        clamp(logs_->value[size_t(k)], std::log(kBroadestLobe), std::log(kSharpestLobe));
  }
}

void LightDescent::restore_power() {
  const Vec3f now = total_power();
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < count_; ++k)
      logs_->value[size_t(1 + c) * padded_ + k] += std::log(first_power_[c] / now[c]);
}

void LightDescent::step(const Device& device, const HitBatch& batch, std::span<const Vec3f> d_irradiance,
                        std::span<const Vec3f> d_reflected, float rate) {
  const std::vector<float> lobes = lobe_planes();
  step(device, lobes_grad(device, {lobes.data(), count_, padded_}, batch, d_irradiance, d_reflected), rate);
}

void LightDescent::step(const Device& device, const std::vector<float>& d_lobes, float rate) {
  set_gradient(lobe_planes(), d_lobes);
  optimizer_.step(device, rate);
  normalize_lobes();
  if (keep_power_) restore_power();
}

}  // namespace cei3d
