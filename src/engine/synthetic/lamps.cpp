// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/lamps.h"

#include <cmath>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/sg.h"
#include "core/math/tangents.h"
#include "engine/synthetic/names.h"

namespace cei3d {
namespace {

struct NamedLight {
  const char* name;
  SgMixture light;
};

// Radiance such that white plaster facing the light is about as bright as an image can show.
std::vector<NamedLight> lights() {
  const auto towards = [](float x, float y, float z) { return normalize(Vec3f{x, y, z}); };
  return {{"daylight",
           {{{{0, 0, 1}, 1.2f, {0.42f, 0.5f, 0.62f}},
             {towards(0.6f, -0.4f, 0.7f), 120, {18, 16.5f, 14}},
             {towards(-1, 0.3f, 0.1f), 5, {0.45f, 0.42f, 0.36f}},
             {{0, 0, -1}, 1.5f, {0.16f, 0.14f, 0.12f}}}}},
          {"evening",
           {{{{0, 0, 1}, 1, {0.3f, 0.36f, 0.52f}},
             {towards(-0.8f, 0.5f, 0.3f), 50, {9, 5.6f, 2.9f}},
             {towards(0.2f, -1, 0.4f), 12, {0.5f, 0.5f, 0.6f}},
             {{0, 0, -1}, 2, {0.12f, 0.11f, 0.1f}}}}},
          {"studio",
           {{{towards(0.3f, 0.9f, 0.6f), 25, {4, 4, 4}},
             {towards(-0.9f, -0.5f, 0.4f), 40, {3.4f, 3.3f, 3.2f}},
             {towards(0.8f, -0.6f, 0.9f), 60, {3.6f, 3.7f, 3.8f}},
             {{0, 0, 1}, 0.5f, {0.16f, 0.16f, 0.16f}}}}}};
}

}  // namespace

std::vector<std::string> light_names() {
  std::vector<std::string> names;
  for (const NamedLight& l : lights()) names.push_back(l.name);
  return names;
}

SgMixture light_by_name(const std::string& name) {
  for (const NamedLight& l : lights())
    if (l.name == name) return l.light;
  fail_usage("There is no light '{}'; there are {}.", name, listed(light_names()));
}

SgMixture turned_with(const SgMixture& light, Vec3d center) {
  const double azimuth = std::atan2(center.y, center.x);
  const float c = float(std::cos(azimuth)), s = float(std::sin(azimuth));
  return rotated(light, Mat3f{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}});
}

LightSampler::LightSampler(const SgMixture& light) {
  float total = 0;
  for (const SgLobe& l : light.lobes) {
    const float power = luminance(l.mu) * sg_integral(l.lambda);
    lobes_.push_back({l, power, 1 / sg_integral(l.lambda)});
    total += power;
  }
  if (!(total > 0)) fail("The light has no radiance.");
  for (Lobe& l : lobes_) l.share /= total;
}

LightSampler::Value LightSampler::at(Vec3f direction) const {
  Value v{{0, 0, 0}, 0};
  for (const Lobe& l : lobes_) {
    const float e = std::exp(l.sg.lambda * (dot(direction, l.sg.axis) - 1));
    v.radiance += l.sg.mu * e;
    v.density += l.share * l.norm * e;
  }
  return v;
}

Vec3f LightSampler::sample(float pick, Vec2<float> u) const {
  size_t k = 0;
  for (; k + 1 < lobes_.size() && pick >= lobes_[k].share; ++k) pick -= lobes_[k].share;
  const SgLobe& sg = lobes_[k].sg;
  // Inverse of the cumulative distribution of the lobe, as 1 - cosine, which is accurate for sharp lobes,
  // too.
  const float fall =
      sg.lambda < 1e-3f ? 2 * u.x : -std::log1p(-u.x * (1 - std::exp(-2 * sg.lambda))) / sg.lambda;
  const float sine = std::sqrt(max(fall * (2 - fall), 0.0f)), turn = 2 * kPi * u.y;
  const Tangents<float> t = tangents_of(sg.axis);
  return normalize(t.x * (sine * std::cos(turn)) + t.y * (sine * std::sin(turn)) + sg.axis * (1 - fall));
}

}  // namespace cei3d
