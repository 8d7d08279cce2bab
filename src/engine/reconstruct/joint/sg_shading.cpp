// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/sg_shading.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/compute/kernels/single_sg.h"
#include "core/compute/planes.h"
#include "core/math/shading.h"
#include "engine/reconstruct/joint/logit.h"
#include "engine/render/lobe_planes.h"

namespace cei3d {
namespace {

constexpr int kGrain = 256;  // points per chunk, a multiple of a panel
enum Row { kSharpness, kAmplitude, kRoughness = 4, kSpecular, kMetalness, kRows };

// What the forward pass has clamped at zero has no derivative.
Vec3f where_positive(Vec3f d, Vec3f value) {
  for (int c = 0; c < 3; ++c)
    if (value[c] <= 0) d[c] = 0;
  return d;
}
MirrorPlanes part(MirrorPlanes p, int begin) {
  p.normals += begin;
  p.views += begin;
  return p;
}

}  // namespace

struct SgShading::Points {
  int stride;
  std::vector<float> normals, views;
  float sharpness;
  MirrorPlanes planes() const { return {stride, normals.data(), views.data(), sharpness}; }
};

SgShading::SgShading(const Device& device, const SgMaterial& m, float rate, AdamConstants adam)
    : device_(device), raw_(&params_.add("raw", {kRows})) {
  raw_->value[kSharpness] = std::log(m.sharpness);
  for (int c = 0; c < 3; ++c) raw_->value[size_t(kAmplitude + c)] = std::log(m.amplitude[c]);
  raw_->value[kRoughness] = logit(m.roughness);
  raw_->value[kSpecular] = logit(m.specular);
  raw_->value[kMetalness] = logit(m.metalness);
  optimizer_.add(params_, "", {.rate = rate, .adam = adam});
}

SgMaterial SgShading::material() const {
  const std::vector<float>& r = raw_->value;
  const auto share = [&](size_t row) { return share_of_logit(r[row]); };
  return {std::exp(r[kSharpness]),
          {std::exp(r[kAmplitude]), std::exp(r[kAmplitude + 1]), std::exp(r[kAmplitude + 2])},
          share(kRoughness),
          share(kSpecular),
          share(kMetalness)};
}

LobePlanes SgShading::lobes() const { return {lobes_.data(), n_lobes_, padded_to_panels(n_lobes_)}; }

SgShading::Points SgShading::points_of(const HitBatch& batch) const {
  const int stride = padded_to_panels(int(batch.size()));
  std::vector<Vec3f> normals, views;
  for (size_t i = 0; i < batch.size(); ++i) {
    normals.push_back(batch.turned.in_room(i, batch.hits[i].normal));
    views.push_back(batch.turned.in_room(i, batch.hits[i].to_camera));
  }
  return {stride, planes_of(normals, stride), planes_of(views, stride), material().sharpness};
}

std::vector<ShadingTerms<float>> SgShading::terms(const SgMixture& light, const HitBatch& batch) {
  lobes_ = lobe_planes(light);
  n_lobes_ = int(light.lobes.size());
  const Points points = points_of(batch);
  std::vector<float> irradiance(size_t(3) * points.stride), mirrored(irradiance.size());
  parallel_ranges(points.stride, kGrain, [&](int begin, int end) {
    device_.launch<SgMirror>(
        {lobes(), part(points.planes(), begin), irradiance.data() + begin, mirrored.data() + begin},
        end - begin);
  });
  irradiance_ = vectors_of(irradiance, points.stride, batch.size());
  mirrored_ = vectors_of(mirrored, points.stride, batch.size());
  const SgMaterial m = material();
  std::vector<ShadingTerms<float>> out;
  for (size_t i = 0; i < batch.size(); ++i) {
    const Hit& h = batch.hits[i];
    out.push_back(
        {irradiance_[i] * diffuse_share(m.metalness),
         {0, 0, 0},
         mirrored_[i] * m.amplitude * mirror_gain(dot(h.normal, h.to_camera), m.roughness, m.specular)});
  }
  return out;
}

ShadingGrads SgShading::grad(const HitBatch& batch, std::span<const Vec3f> albedo,
                             std::span<const Vec3f> d_radiance) {
  const SgMaterial m = material();
  const float matte = diffuse_share(m.metalness);
  ShadingGrads out(batch.size());
  std::vector<Vec3f> d_mirrored(batch.size());
  double d_raw[kRows] = {};
  for (size_t i = 0; i < batch.size(); ++i) {
    const Hit& h = batch.hits[i];
    const Vec3f d = d_radiance[i], lit = irradiance_[i], mirrored = mirrored_[i];
    const MirrorGainGrad<float> gain = mirror_gain_grad(dot(h.normal, h.to_camera), m.roughness, m.specular);
    const float d_gain = dot(d, mirrored * m.amplitude);
    out.d_albedo[i] = d * lit * matte;
    out.d_sky_irradiance[i] = where_positive(d * albedo[i] * matte, lit);
    d_mirrored[i] = where_positive(d * m.amplitude * gain.value, mirrored);
    out.d_normal[i] = h.to_camera * (d_gain * gain.d_nv);
    for (int c = 0; c < 3; ++c)
      d_raw[kAmplitude + c] += double(d[c] * mirrored[c] * m.amplitude[c] * gain.value);
    d_raw[kRoughness] += double(d_gain * gain.d_roughness);
    d_raw[kSpecular] += double(d_gain * gain.d_specular);
    d_raw[kMetalness] -= double(dot(d, albedo[i] * lit) * diffuse_share(0.0f));
  }
  const Points points = points_of(batch);
  d_raw[kSharpness] = light_grad(batch, points, d_mirrored, out) * double(m.sharpness);
  const std::span<float> gradient = optimizer_.gradient(*raw_);
  for (size_t r = 0; r < kRows; ++r) {
    const float value_by_raw = r < kRoughness ? 1 : Sigmoid::eval(raw_->value[r], 1).first;
    gradient[r] += float(d_raw[r]) * value_by_raw;
  }
  return out;
}

// Adds to the normals' derivatives and sets those of the lobes; returns that by the sharpness.
double SgShading::light_grad(const HitBatch& batch, const Points& points, std::span<const Vec3f> d_mirrored,
                             ShadingGrads& out) {
  const int stride = points.stride, padded = lobes().padded, chunks = (stride + kGrain - 1) / kGrain;
  const std::vector<float> e = planes_of(out.d_sky_irradiance, stride), g = planes_of(d_mirrored, stride);
  std::vector<float> d_normals(size_t(3) * stride), d_sharpness(size_t(stride), 0.0f);
  std::vector<std::vector<float>> d_lobes(size_t(chunks), std::vector<float>(size_t(7) * padded));
  parallel_for(chunks, [&](int c) {
    const int begin = c * kGrain, end = min(stride, begin + kGrain);
    device_.launch<SgMirrorGrad>({.lobes = lobes(),
                                  .points = part(points.planes(), begin),
                                  .d_irradiance = e.data() + begin,
                                  .d_mirrored = g.data() + begin,
                                  .d_normals = d_normals.data() + begin,
                                  .d_sharpness = d_sharpness.data() + begin},
                                 end - begin);
    device_.launch<SgMirrorLobesGrad>({.lobes = lobes(),
                                       .points = points.planes(),
                                       .begin = begin,
                                       .end = min(end, int(batch.size())),
                                       .d_irradiance = e.data(),
                                       .d_mirrored = g.data(),
                                       .d_lobes = d_lobes[size_t(c)].data()},
                                      padded);
  });
  d_lobes_.assign(size_t(7) * padded, 0.0f);
  for (const std::vector<float>& some : d_lobes)
    for (size_t i = 0; i < some.size(); ++i) d_lobes_[i] += some[i];
  double sharpness = 0;
  for (size_t i = 0; i < batch.size(); ++i) {
    const Vec3f n = batch.hits[i].normal;
    const Vec3f d =
        out.d_normal[i] + batch.turned.in_object(i, load_planes<float>(d_normals.data(), stride, int(i)));
    out.d_normal[i] = d - n * dot(n, d);
    sharpness += double(d_sharpness[i]);
  }
  return sharpness;
}

void SgShading::update(float rate) { optimizer_.step(device_, rate); }

void SgShading::save(Tensors& out, const std::string& prefix) const {
  params_.save(out, prefix);
  optimizer_.save(out, prefix + "_adam");
}
void SgShading::load(const Tensors& in, const std::string& prefix) {
  params_.load(in, prefix);
  optimizer_.load(in, prefix + "_adam");
}

}  // namespace cei3d
