// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_descent.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/compute/kernels/adam.h"
#include "core/compute/kernels/shade.h"

namespace cei3d {
namespace {

constexpr int kRows = 7;
constexpr int kGrain = 512;                           // hits a chunk
constexpr float kLogRate = 1e-2f, kAxisRate = 2e-3f;  // of Adam, on logarithms and on unit vectors
constexpr float kDarkest = 1e-5f;
constexpr float kBeta1 = 0.9f, kBeta2 = 0.99f;

std::vector<float> planes_of(std::span<const Vec3f> v, int stride) {
  std::vector<float> p(size_t(3) * stride, 0);
  for (size_t i = 0; i < v.size(); ++i)
    for (int c = 0; c < 3; ++c) p[size_t(c) * stride + i] = v[i][c];
  return p;
}

}  // namespace

LightDescent::LightDescent(const SgMixture& light, float roughness, bool keep_power)
    : count_(int(light.lobes.size())),
      padded_((count_ + kPanel - 1) / kPanel * kPanel),
      roughness_(roughness),
      keep_power_(keep_power) {
  planes_.assign(size_t(kRows) * padded_, 0);
  gradient_ = m_ = v_ = planes_;
  for (int k = 0; k < count_; ++k) {
    const SgLobe& l = light.lobes[k];
    const float row[kRows] = {l.axis.x,
                              l.axis.y,
                              l.axis.z,
                              std::log(l.lambda),
                              std::log(max(l.mu.x, kDarkest)),
                              std::log(max(l.mu.y, kDarkest)),
                              std::log(max(l.mu.z, kDarkest))};
    for (int j = 0; j < kRows; ++j) planes_[size_t(j) * padded_ + k] = row[j];
  }
  first_power_ = power();
}

Vec3f LightDescent::power() const {
  Vec3f sum{0, 0, 0};
  for (const SgLobe& l : light().lobes) sum += l.mu * sg_integral(l.lambda);
  return sum;
}

SgMixture LightDescent::light() const {
  SgMixture out;
  for (int k = 0; k < count_; ++k) {
    const auto at = [&](int row) { return planes_[size_t(row) * padded_ + k]; };
    out.lobes.push_back(
        {{at(0), at(1), at(2)}, std::exp(at(3)), {std::exp(at(4)), std::exp(at(5)), std::exp(at(6))}});
  }
  return out;
}

void LightDescent::step(const Device& device, std::span<const Hit> hits, std::span<const Vec3f> d_irradiance,
                        std::span<const Vec3f> d_reflected, float rate) {
  const int n = int(hits.size());
  std::vector<Vec3f> normals(n), mirrors(n);
  for (int i = 0; i < n; ++i) {
    normals[i] = hits[i].normal;
    mirrors[i] = mirror_direction(hits[i]);
  }
  const std::vector<float> np = planes_of(normals, n), mp = planes_of(mirrors, n),
                           ep = planes_of(d_irradiance, n), rp = planes_of(d_reflected, n);
  std::vector<float> lobes(planes_);
  for (int j = 3; j < kRows; ++j)
    for (int k = 0; k < padded_; ++k) {
      float& x = lobes[size_t(j) * padded_ + k];
      x = k < count_ ? std::exp(x) : 0.0f;
    }
  const int chunks = (n + kGrain - 1) / kGrain;
  std::vector<std::vector<float>> parts(chunks, std::vector<float>(planes_.size()));
  parallel_for(chunks, [&](int c) {
    SgShadeGrad::Args a{{lobes.data(), count_, padded_},
                        {},
                        {},
                        n,
                        c * kGrain,
                        min(n, (c + 1) * kGrain),
                        np.data(),
                        mp.data(),
                        ep.data(),
                        rp.data(),
                        parts[c].data()};
    set_reflection_lobe(roughness_, a);
    device.launch<SgShadeGrad>(a, padded_);
  });
  gradient_.assign(planes_.size(), 0);
  for (const auto& part : parts)
    for (size_t i = 0; i < part.size(); ++i) gradient_[i] += part[i];
  for (int k = 0; k < count_; ++k) {
    const auto at = [&](std::vector<float>& p, int row) -> float& { return p[size_t(row) * padded_ + k]; };
    for (int j = 3; j < kRows; ++j) at(gradient_, j) *= at(lobes, j);  // of logarithms
    const Vec3f axis{at(planes_, 0), at(planes_, 1), at(planes_, 2)};
    const Vec3f d{at(gradient_, 0), at(gradient_, 1), at(gradient_, 2)}, along = d - axis * dot(d, axis);
    for (int j = 0; j < 3; ++j) at(gradient_, j) = along[j];
  }
  ++steps_;
  const float correction =
      std::sqrt(1 - std::pow(kBeta2, float(steps_))) / (1 - std::pow(kBeta1, float(steps_)));
  for (int j = 0; j < kRows; ++j) {
    const float r = j < 3 ? kAxisRate : kLogRate;
    const size_t row = size_t(j) * padded_;
    device.launch<Adam>({{rate * r * correction, kBeta1, kBeta2, 1e-12f, false},
                         &planes_[row],
                         &gradient_[row],
                         &m_[row],
                         &v_[row]},
                        padded_);
  }
  for (int k = 0; k < count_; ++k) {
    const auto at = [&](int row) -> float& { return planes_[size_t(row) * padded_ + k]; };
    const Vec3f axis = normalize(Vec3f{at(0), at(1), at(2)});
    for (int j = 0; j < 3; ++j) at(j) = axis[j];
    at(3) = clamp(at(3), std::log(kBroadestLobe), std::log(kSharpestLobe));
  }
  if (!keep_power_) return;
  const Vec3f now = power();
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < count_; ++k)
      planes_[size_t(4 + c) * padded_ + k] += std::log(first_power_[c] / now[c]);
}

}  // namespace cei3d
