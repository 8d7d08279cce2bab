// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_descent.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/compute/kernels/shade.h"
#include "core/math/dual.h"
#include "core/math/rng.h"
#include "core/math/rotation.h"
#include "engine/reconstruct/appearance/sample_grad.h"
#include "engine/render/hit_reflection.h"

namespace cei3d {
namespace {

using D = Dual<double>;
constexpr int kHits = 700, kLobes = 5;  // more hits than one chunk takes

Vec3f random_direction(Rng& rng) { return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}); }

struct Problem {
  std::vector<Hit> hits;
  std::vector<Material> materials;
  std::vector<Vec3f> d_irradiance, d_reflected;
  SgMixture light;

  Problem() {
    for (uint64_t i = 0; i < kHits; ++i) {
      Rng rng(1, 0, i);
      Hit h{};
      h.normal = random_direction(rng);
      h.to_camera = normalize(random_direction(rng) + h.normal * 1.2f);
      hits.push_back(h);
      materials.push_back({0.2f + 0.7f * rng.uniform(), 0.5f, 0});
      d_irradiance.push_back({rng.normal(), rng.normal(), rng.normal()});
      d_reflected.push_back({rng.normal(), rng.normal(), rng.normal()});
    }
    for (uint64_t k = 0; k < kLobes; ++k) {
      Rng rng(2, 0, k);
      light.lobes.push_back({random_direction(rng),
                             1 + 30 * rng.uniform(),
                             {0.2f + rng.uniform(), 0.2f + rng.uniform(), 0.2f + rng.uniform()}});
    }
  }
  HitBatch batch() const { return {hits, materials}; }
};

// A lobe's axis, sharpness and color as seven numbers, in the order of the planes.
std::array<D, 7> dual_lobe(const SgLobe& l, int varied) {
  const float x[7] = {l.axis.x, l.axis.y, l.axis.z, l.lambda, l.mu.x, l.mu.y, l.mu.z};
  std::array<D, 7> d;
  for (int j = 0; j < 7; ++j) d[size_t(j)] = D(double(x[j]), j == varied ? 1.0 : 0.0);
  return d;
}

// Derivative of the loss sum(d_irradiance . irradiance + d_reflected . reflection) by one number of a lobe.
double slope(const Problem& p, int lobe, int member) {
  const std::array<D, 7> x = dual_lobe(p.light.lobes[size_t(lobe)], member);
  const Vec3<D> axis{x[0], x[1], x[2]};
  const auto dual = [](Vec3f v) { return Vec3<D>{D(v.x), D(v.y), D(v.z)}; };
  double sum = 0;
  for (size_t i = 0; i < kHits; ++i) {
    const SurfaceReflection<float> s = reflection_of(p.hits[i], p.materials[i]);
    const auto along = [&](const LobeFrame<float>& a) {
      const LobeGap<D> gap = lobe_gap(dual(a.axis), dual(a.across), axis);
      const StretchedLobe<D> lobe = stretched_lobe(D(a.roughness), D(a.stretch));
      return sg_reflected(x[3], lobe, gap.q(), gap.h()) *
             horizon_of(lobe, D(dot(a.axis, a.normal))).share(x[3], dot(dual(a.normal), axis));
    };
    const D e = sg_irradiance(x[3], dot(dual(p.hits[i].normal), axis)),
            r = D(s.share) * along(s.base) + D(1 - s.share) * along(s.fresnel);
    for (int c = 0; c < 3; ++c)
      sum += derivative_of(x[size_t(4 + c)] * (e * D(p.d_irradiance[i][c]) + r * D(p.d_reflected[i][c])));
  }
  return sum;
}

TEST(LightDescent, GradientOfEveryLobeEqualsDualNumbers) {
  const Problem p;
  std::vector<float> planes(7 * kPanel, 0.0f);
  for (int k = 0; k < kLobes; ++k) {
    const std::array<D, 7> x = dual_lobe(p.light.lobes[size_t(k)], -1);
    for (int j = 0; j < 7; ++j) planes[size_t(j * kPanel + k)] = float(x[size_t(j)].value);
  }
  for (const Device& device : all_devices()) {
    const std::vector<float> got =
        lobes_grad(device, {planes.data(), kLobes, kPanel}, p.batch(), p.d_irradiance, p.d_reflected);
    for (int k = 0; k < kLobes; ++k)
      for (int j = 0; j < 7; ++j) {
        const double want = slope(p, k, j);
        // The cosine's closed form is a difference of numbers 32 times larger, in single precision.
        EXPECT_NEAR(got[size_t(j * kPanel + k)], want, 2e-3 * (10 + std::abs(want)))
            << device.name() << " lobe " << k << " member " << j;
      }
  }
}

// Turning the light against a hit is turning the hit the other way.
TEST(LightDescent, GradientUnderATurningLightIsThatOfTurnedHits) {
  const Problem p;
  const LightTurns turns = light_turns({about_axis({0, 0, 1}, 1), about_axis({0.6f, 0, 0.8f}, -2)});
  std::vector<uint16_t> views;
  std::vector<Hit> turned = p.hits;
  for (size_t i = 0; i < kHits; ++i) {
    views.push_back(uint16_t(i % 2));
    turned[i].normal = turns.room_from_object[i % 2] * p.hits[i].normal;
    turned[i].to_camera = turns.room_from_object[i % 2] * p.hits[i].to_camera;
  }
  const LightDescent descent(p.light, false);
  std::vector<float> planes(7 * kPanel, 0.0f);
  for (int k = 0; k < kLobes; ++k)
    for (int j = 0; j < 7; ++j)
      planes[size_t(j * kPanel + k)] = float(dual_lobe(p.light.lobes[size_t(k)], -1)[size_t(j)].value);
  const LobePlanes lobes{planes.data(), kLobes, kPanel};
  const Device device = make_device();
  const std::vector<float> got = lobes_grad(device, lobes, {p.hits, p.materials, {&turns, views}},
                                            p.d_irradiance, p.d_reflected),
                           want = lobes_grad(device, lobes, {turned, p.materials}, p.d_irradiance,
                                             p.d_reflected);
  for (size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], want[i], 2e-3f * (10 + std::abs(want[i]))) << i;
}

// Squared distance of the light that a mixture sends to the hits from that of another one, and its gradient.
double distance_to(const Problem& p, const SgMixture& light, const SgMixture& wanted, std::vector<Vec3f>& d_e,
                   std::vector<Vec3f>& d_r) {
  const auto sent = [&](const SgMixture& m, size_t i, bool reflected) {
    Vec3f sum{0, 0, 0};
    const SurfaceReflection<float> s = reflection_of(p.hits[i], p.materials[i]);
    const auto along = [](const LobeFrame<float>& a, const SgLobe& l) {
      const LobeGap<float> gap = lobe_gap(a.axis, a.across, l.axis);
      const StretchedLobe<float> lobe = stretched_lobe(a.roughness, a.stretch);
      return sg_reflected(l.lambda, lobe, gap.q(), gap.h()) *
             horizon_of(lobe, dot(a.axis, a.normal)).share(l.lambda, dot(a.normal, l.axis));
    };
    for (const SgLobe& l : m.lobes)
      sum += l.mu * (reflected ? s.share * along(s.base, l) + (1 - s.share) * along(s.fresnel, l)
                               : sg_irradiance(l.lambda, dot(p.hits[i].normal, l.axis)));
    return sum;
  };
  double sum = 0;
  for (size_t i = 0; i < kHits; ++i) {
    d_e[i] = sent(light, i, false) - sent(wanted, i, false);
    d_r[i] = sent(light, i, true) - sent(wanted, i, true);
    sum += double(dot(d_e[i], d_e[i]) + dot(d_r[i], d_r[i]));
  }
  return sum / kHits;
}

TEST(LightDescent, FindsBackToTheLightAndKeepsItsPower) {
  const Device device = make_device();
  Problem p;
  const SgMixture wanted = p.light;
  for (SgLobe& l : p.light.lobes) {
    l.axis = normalize(l.axis + Vec3f{0.03f, -0.04f, 0.02f});
    l.lambda *= 1.12f;
    l.mu = l.mu * (sg_integral(l.lambda / 1.12f) / sg_integral(l.lambda));  // of the same power
  }
  LightDescent descent(p.light, true);
  const double before = distance_to(p, p.light, wanted, p.d_irradiance, p.d_reflected);
  for (int step = 0; step < 60; ++step) {
    distance_to(p, descent.light(), wanted, p.d_irradiance, p.d_reflected);
    descent.step(device, p.batch(), p.d_irradiance, p.d_reflected, std::pow(0.1f, float(step) / 60));
  }
  EXPECT_LT(distance_to(p, descent.light(), wanted, p.d_irradiance, p.d_reflected), 0.01 * before);
  const auto power = [](const SgMixture& m) {
    double sum = 0;
    for (const SgLobe& l : m.lobes) sum += double(l.mu.y) * sg_integral(l.lambda);
    return sum;
  };
  EXPECT_NEAR(power(descent.light()) / power(wanted), 1, 1e-4);
}

TEST(SampleGrad, EqualsDifferencesOfTheDisplayLossOfADielectricSample) {
  const std::vector<Hit> hits(1);
  const std::vector<Vec3f> colors{{0.3f, 0.05f, 0.7f}};
  const SurfaceSamples samples{hits, colors, {}, {}};
  const ShadingTerms<float> terms{{0.6f, 0.5f, 0.9f}, {0.1f, 0.2f, 0.1f}, {0.02f, 0.01f, 0.05f}};
  const auto loss = [&](Vec3f albedo, int c) {
    const double error = srgb_from_linear(terms.radiance(albedo)[c]) - srgb_from_linear(colors[0][c]);
    return huber(error, 0.05).value;
  };
  for (const Vec3f albedo : {Vec3f{0.2f, 0.5f, 0.4f}, Vec3f{0.4f, 0.06f, 0.75f}}) {
    const SampleGrad g = sample_grad(samples, 0, terms, albedo, 2);
    for (int c = 0; c < 3; ++c) {
      Vec3f up = albedo, down = albedo;
      up[c] += 1e-3f, down[c] -= 1e-3f;
      const double want = 2 * (loss(up, c) - loss(down, c)) / 2e-3;
      EXPECT_NEAR(g.d_albedo[c], want, 0.01 * std::abs(want) + 1e-4) << c;
      EXPECT_NEAR(g.d_radiance[c] * terms.gain()[c], g.d_albedo[c], 1e-6);
    }
  }
}

}  // namespace
}  // namespace cei3d
