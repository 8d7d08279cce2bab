// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/render/lighting.h"
#include "model/light/fit.h"

namespace cei3d {

namespace {

constexpr int kBatch = 8192;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

LinearSplitOptions split_options(const AppearanceOptions& o) {
  LinearSplitOptions s;
  s.seed = o.seed;
  if (o.seconds > 0 && o.seconds < 40) {
    s.most_hits = 200000;
    s.search_hits = 80000;
    s.roughness_solves = 4;
    s.light_height = 32;
  }
  return s;
}

// Every sample's radiance is linear in its base colour: dark + a (bright - dark), for dielectrics and metals alike.
struct LinearInAlbedo {
  std::vector<Vec3f> dark, gain;
};

LinearInAlbedo linear_in_albedo(const Lighting& lighting, std::span<const Hit> hits) {
  LinearInAlbedo l;
  const Shading dark = lighting.shade(hits, std::vector<Vec3f>(hits.size(), {0, 0, 0}));
  const Shading bright = lighting.shade(hits, std::vector<Vec3f>(hits.size(), {1, 1, 1}));
  for (size_t i = 0; i < hits.size(); ++i) {
    l.dark.push_back(dark.diffuse[i] + dark.specular[i]);
    l.gain.push_back(bright.diffuse[i] + bright.specular[i] - l.dark.back());
  }
  return l;
}

// Slope of the sRGB curve at a linear value, bounded where it is steep.
float srgb_slope(float linear) { return 1.055f / 2.4f * std::pow(std::max(linear, 0.004f), 1 / 2.4f - 1); }

void fit_albedo(const Device& device, Field& field, const SurfaceSamples& samples, const LinearInAlbedo& model, int steps,
                uint64_t seed, Progress& progress) {
  FieldTrainer trainer(field, {});
  std::vector<Vec3f> x(kBatch);
  std::vector<uint32_t> chosen(kBatch);
  for (int step = 0; step < steps && !progress.cancelled(); ++step) {
    for (int i = 0; i < kBatch; ++i) {
      chosen[i] = Rng(seed, uint64_t(step), uint64_t(i)).below(uint32_t(samples.hits.size()));
      x[i] = samples.hits[chosen[i]].position;
    }
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i) {
        const uint32_t s = chosen[i];
        if (!samples.saturated.empty() && samples.saturated[s]) continue;
        for (int c = 0; c < 3; ++c) {
          const int k = 3 * (i - begin) + c;
          const float got = model.dark[s][c] + out[k] * model.gain[s][c];
          const float e = srgb_from_linear(std::max(got, 0.0f)) - srgb_from_linear(samples.colors[s][c]);
          d_out[k] = huber(e, 0.05f).gradient * srgb_slope(got) * model.gain[s][c] / float(kBatch);
        }
      }
    };
    trainer.step(device, x, loss, std::pow(0.05f, float(step) / float(steps)));
    if (step % 100 == 0) progress.report({"albedo", 0.92 + 0.07 * step / steps, -1, ""});
  }
}

}  // namespace

AppearanceResult fit_appearance(const Device& device, const AppearanceInput& input, const AppearanceOptions& options,
                                Progress& progress) {
  const double start = now();
  AppearanceResult result;
  progress.report({"light", 0.8, options.seconds, ""});
  {
    const Transport transport(input.surface);
    result.split = linear_split(transport, input.samples, split_options(options), progress);
  }
  result.material = result.split.material;
  progress.log(Json{{"stage", "linear split"}, {"seconds", now() - start}, {"roughness", result.material.roughness},
                    {"metalness", result.material.metalness}}.dump());
  progress.report({"lobes", 0.9, -1, ""});
  LobeFitOptions lobes;
  lobes.height = result.split.light.height;
  lobes.seen_through = 0.5f / std::pow(result.material.roughness, 4.0f);
  result.light = fit_lobes(device, result.split.light, lobes);
  const Lighting lighting(device, input.surface, result.light, result.split.albedo, result.material);
  const LinearInAlbedo model = linear_in_albedo(lighting, input.samples.hits);
  Field albedo(options.albedo, options.seed + 100);
  const int steps = options.seconds > 0 && options.seconds < 40 ? 500 : 1500;
  fit_albedo(device, albedo, input.samples, model, steps, options.seed, progress);
  result.albedo = std::make_shared<const Field>(std::move(albedo));
  progress.log(Json{{"stage", "appearance"}, {"seconds", now() - start}}.dump());
  return result;
}

}  // namespace cei3d
