// SPDX-License-Identifier: Apache-2.0
#include "model/light/fit.h"

#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/compute/kernels/adam.h"
#include "core/compute/kernels/light.h"
#include "core/math/fibonacci.h"
#include "core/math/raw_lobe.h"
#include "core/math/sg.h"
#include "model/light/refine_colors.h"

namespace cei3d {
namespace {

constexpr int kRows = 7;  // axis, lambda, color
constexpr float kRate = 0.03f, kBeta1 = 0.9f, kBeta2 = 0.99f;

Image blurred(const Image& map, float lambda, EnvUp up) {
  Image out(map.width, map.height, 3);
  std::vector<Vec3f> directions;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      directions.push_back(env_direction(float(x) + 0.5f, float(y) + 0.5f, map.width, map.height, up));
  parallel_for(map.height, [&](int y) {
    for (int x = 0; x < map.width; ++x) {
      const Vec3f d = directions[size_t(y) * map.width + x];
      Vec3f sum{0, 0, 0};
      float total = 0;
      for (int i = 0; i < map.width * map.height; ++i) {
        const float t = lambda * (dot(d, directions[i]) - 1);
        if (t < -12) continue;
        const float w = std::exp(t) * env_solid_angle(i / map.width, map.width, map.height);
        sum += map.rgb(i % map.width, i / map.width) * w;
        total += w;
      }
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = sum[c] / total;
    }
  });
  return out;
}

// The lobe that becomes `seen` when blurred by a lobe of sharpness `kernel`; same energy.
SgLobe unblurred(SgLobe seen, float kernel) {
  const float lambda = min(seen.lambda * kernel / (kernel - seen.lambda), kSharpestLobe);
  return {seen.axis, lambda, seen.mu * (sg_integral(seen.lambda) / sg_integral(lambda))};
}

// Unknowns: raw numbers of the lobes, as planes [7][padded].
class LobeFit {
 public:
  LobeFit(const Image& map, int lobes, float sharpest, EnvUp up)
      : lobes_(lobes),
        sharpest_(sharpest),
        p_(padded_to_panels(lobes)),
        cells_(padded_to_panels(map.width * map.height)) {
    for (auto* v : {&raw_, &gradient_, &m_, &v_, &planes_, &d_planes_}) v->assign(size_t(kRows) * p_, 0);
    directions_.assign(3 * size_t(cells_), 0);
    roots_ = d_radiance_ = directions_;
    weights_.assign(cells_, 0);
    for (int i = 0; i < map.width * map.height; ++i) {
      const int x = i % map.width, y = i / map.width;
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, map.width, map.height, up),
                  c = map.rgb(x, y);
      for (int k = 0; k < 3; ++k) {
        directions_[size_t(k) * cells_ + i] = d[k];
        roots_[size_t(k) * cells_ + i] = std::sqrt(max(c[k], 0.0f) + 1e-4f);
      }
      weights_[i] = env_solid_angle(y, map.width, map.height);
    }
    for (int k = 0; k < lobes; ++k) {
      const Vec3f axis = fibonacci_direction(k, lobes);
      Vec3f root = env_radiance(map, axis, up);
      for (int j = 0; j < 3; ++j) root[j] = std::sqrt(max(0.6f * root[j], 1e-3f));  // neighbors overlap
      put(raw_, k, {axis, std::log(min(0.5f * float(lobes), 0.5f * sharpest)), root});
    }
  }

  void step(const Device& device, int t, float rate) {
    expand();
    const SgFitArgs args{.lobes = {planes_.data(), lobes_, p_},
                         .cells = cells_,
                         .directions = directions_.data(),
                         .roots = roots_.data(),
                         .weights = weights_.data(),
                         .d_radiance = d_radiance_.data(),
                         .d_lobes = d_planes_.data()};
    device.launch<SgFitResidual>(args, cells_);
    device.launch<SgFitGather>(args, p_);
    pull_back();
    const auto correction = float(bias_correction(kBeta1, kBeta2, t + 1));
    const AdamStep adam{.rate = kRate * rate * correction,
                        .beta1 = kBeta1,
                        .beta2 = kBeta2,
                        .eps = 1e-8f,
                        .skip_zero = false};
    device.launch<Adam>(
        {.step = adam, .value = raw_.data(), .gradient = gradient_.data(), .m = m_.data(), .v = v_.data()},
        kRows * p_);
    for (int k = 0; k < lobes_; ++k) {
      float& s = row(raw_, 3)[k];
      s = clamp(s, std::log(kBroadestLobe), std::log(sharpest_));
    }
  }

  SgMixture lobes() {
    expand();
    SgMixture light;
    for (int k = 0; k < lobes_; ++k) {
      const LobeNumbers<float> l = get(planes_, k);
      light.lobes.push_back({l.axis, l.lambda, l.color});
    }
    return light;
  }

 private:
  float* row(std::vector<float>& planes, int r) { return planes.data() + size_t(r) * p_; }
  LobeNumbers<float> get(std::vector<float>& planes, int k) {
    return {load_planes<float>(row(planes, 0), p_, k), row(planes, 3)[k],
            load_planes<float>(row(planes, 4), p_, k)};
  }
  void put(std::vector<float>& planes, int k, const LobeNumbers<float>& l) {
    store_planes(row(planes, 0), p_, k, l.axis);
    row(planes, 3)[k] = l.lambda;
    store_planes(row(planes, 4), p_, k, l.color);
  }

  void expand() {
    for (int k = 0; k < lobes_; ++k) put(planes_, k, lobe_of_raw(get(raw_, k)));
  }
  void pull_back() {
    for (int k = 0; k < lobes_; ++k) put(gradient_, k, lobe_of_raw_grad(get(raw_, k), get(d_planes_, k)));
  }

  int lobes_;
  float sharpest_;
  int p_, cells_;
  std::vector<float> raw_, gradient_, m_, v_, planes_, d_planes_;
  std::vector<float> directions_, roots_, weights_, d_radiance_;
};

}  // namespace

SgMixture fit_lobes(const Device& device, const Image& lat_long, const LobeFitOptions& options, EnvUp up,
                    const Progress& progress) {
  if (lat_long.empty() || lat_long.channels < 3) fail("A light map must be a color image.");
  for (const float x : lat_long.data)
    if (!std::isfinite(x)) fail("A value of the light map is not finite.");
  Image map = env_resample(lat_long, std::min(options.height, lat_long.height));
  const float kernel = options.seen_through;
  if (kernel > 0) map = blurred(map, kernel, up);
  LobeFit fit(map, options.lobes, kernel > 0 ? 0.7f * kernel : kSharpestLobe, up);
  for (int t = 0; t < options.steps; ++t) {
    check_cancelled(progress);
    fit.step(device, t, std::pow(0.02f, float(t) / float(options.steps)));
  }
  SgMixture light = refine_colors(fit.lobes(), kernel > 0 ? map : lat_long, up);
  if (kernel > 0)
    for (SgLobe& l : light.lobes) l = unblurred(l, kernel);
  return light;
}

}  // namespace cei3d
