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
#include "engine/reconstruct/appearance/appearance_descent.h"
#include "model/light/fit.h"

namespace cei3d {

namespace {

LinearSplitOptions split_options(const AppearanceOptions& o, bool turning) {
  LinearSplitOptions s;
  s.seed = o.seed;
  s.fixed_roughness = o.roughness;
  s.light_color = o.light_color;
  s.several_expected = o.several_materials;
  if (o.effort == Effort::brief) {
    s.max_hits = 200000;
    s.search_hits = 120000;
    s.material_hits = 300000;
    s.light_height = 32;
  }
  if (o.effort == Effort::brief && turning) s.scan_step = 1.7f;  // each solve takes twice as long
  return s;
}

constexpr float kAllMetal = 0.97f;  // mean metalness

bool all_metal(const MaterialField& material) { return material.mean().metalness > kAllMetal; }

// Steps of the descent on albedo, material and light together (docs/notebook/0023).
int refine_steps_for(const MaterialField& material, bool brief) {
  if (all_metal(material)) return brief ? 120 : 400;
  return material.varying() ? (brief ? 60 : 600) : (brief ? 30 : 400);
}

// Rate of the albedo while all descend, of its full rates. Nothing but the albedo holds the light of
// metals: at full rates both wander.
float refine_albedo_rate(const MaterialField& material) { return all_metal(material) ? 0.1f : 1.0f; }

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
  lobes.seen_through = 0.5f * reflection_shape(result.split.smoothest).scale;
  result.light = fit_lobes(device, result.split.light, lobes, EnvUp::z, progress);
  result.material = fit_materials(device, input, options, result.split, progress);
  return result;
}

void descend_on_appearance(const Device& device, const AppearanceInput& input,
                           const AppearanceOptions& options, const std::vector<Vec3f>& vertex_albedo,
                           AppearanceResult& result, Progress& progress, const DescentStore& store) {
  const double start = steady_seconds();
  const bool brief = options.effort == Effort::brief;
  AppearanceDescent descent(device, input, transport_of(input, progress), options,
                            Field(options.albedo, options.seed + 100), vertex_albedo, result, progress);
  const int albedo_steps = options.albedo_steps >= 0 ? options.albedo_steps
                           : brief                   ? 300
                                                     : 800,
            refine_steps =
                options.refine_steps >= 0 ? options.refine_steps : refine_steps_for(result.material, brief);
  // The strength of the light is determined only by reflections of dielectrics.
  descent.run({.albedo = int(std::ceil(options.descent_share * albedo_steps)),
               .refine = int(std::ceil(options.descent_share * refine_steps)),
               .albedo_rate = 1,
               .refine_albedo_rate = refine_albedo_rate(result.material),
               .keep_power = !all_metal(result.material)},
              store);
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
  AppearanceDescent descent(device, input, transport_of(input, progress), options, *result.albedo,
                            result.albedo->eval3(device, input.surface->mesh().positions), result, progress);
  descent.run({.albedo = steps, .albedo_rate = 0.2f}, {});
  result.albedo = std::make_shared<const Field>(descent.take_albedo());
}

}  // namespace cei3d
