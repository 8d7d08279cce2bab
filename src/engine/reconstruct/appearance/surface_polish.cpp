// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/surface_polish.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/display_loss.h"
#include "engine/render/lighting.h"
#include "engine/render/render.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {
namespace {

class Polish {
 public:
  Polish(const Device& device, GeometryStage& stage, const AppearanceInput& input,
         const AppearanceResult& appearance, const PolishOptions& options, const Progress& progress)
      : device_(device),
        stage_(stage),
        samples_(input.samples),
        appearance_(appearance),
        options_(options),
        progress_(progress),
        albedo_(*appearance.albedo),
        trainer_(albedo_, {}),
        lighting_(device, input.surface, appearance.light,
                  turned_vertex_lights(Transport(input.surface, {}, progress), appearance.light,
                                       {albedo_.eval3(device, input.surface->mesh().positions),
                                        appearance.material.at(device, input.surface->mesh().positions)},
                                       input.samples.turned.turns)) {}

  // share: progress of polishing, [0, 1).
  GeometryStats step(int step, double share) {
    choose_batch(step);
    refine_hits(device_, stage_.sdf(), directions_, hits_, edges_);
    std::vector<Vec3f> positions;
    for (const Hit& h : hits_) positions.push_back(h.position);
    materials_ = appearance_.material.at(device_, positions);
    const std::vector<uint16_t> views = views_of(samples_.turned, batch_);
    const HitBatch batch{hits_, materials_, {samples_.turned.turns, views}};
    const std::vector<IncidentLight<float>> light = lighting_.incident_light(batch);
    fit_albedo(positions, lighting_.terms(batch, light));
    std::vector<Vec3f> d_normals = lighting_.grad(batch, light, colors_, d_radiance_).d_normal, points;
    std::vector<float> d_values;
    for (Vec3f& d : d_normals) d = d * options_.weight;
    add_value_grads(stage_.sdf().config(), positions, d_normals, edges_, points, d_values);
    return stage_.step(options_.first_step + step, options_.from + (1 - options_.from) * share,
                       {points, d_values}, progress_);
  }

 private:
  void choose_batch(int step) {
    const int n = options_.batch;
    batch_.resize(n);
    hits_.resize(n);
    directions_.resize(n);
    edges_.resize(n);
    for (int i = 0; i < n; ++i) {
      batch_[i] =
          Rng(options_.seed ^ 0x9011, uint64_t(step), uint64_t(i)).below(uint32_t(samples_.hits.size()));
      hits_[i] = samples_.hits[batch_[i]];
      directions_[i] = -hits_[i].to_camera;
    }
  }

  // One step of the albedo, which has compensated wrong normals and would keep them. Sets colors_ and
  // d_radiance_.
  void fit_albedo(const std::vector<Vec3f>& positions, const std::vector<ShadingTerms<float>>& terms) {
    colors_.resize(hits_.size());
    d_radiance_.resize(hits_.size());
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i) {
        const float* a = out + 3 * (i - begin);
        colors_[i] = {a[0], a[1], a[2]};
        const SampleGrad g =
            sample_grad(samples_, batch_[i], terms[i], colors_[i], 1 / float(options_.batch));
        d_radiance_[i] = g.d_radiance;
        for (int c = 0; c < 3; ++c) d_out[3 * (i - begin) + c] = g.d_albedo[c];
      }
    };
    trainer_.step(device_, positions, loss, 0.1f);
  }

  const Device& device_;
  GeometryStage& stage_;
  SurfaceSamples samples_;
  const AppearanceResult& appearance_;
  PolishOptions options_;
  const Progress& progress_;
  Field albedo_;
  FieldTrainer trainer_;
  Lighting lighting_;
  std::vector<Material> materials_;  // of the hits
  std::vector<uint32_t> batch_;
  std::vector<Hit> hits_;
  std::vector<Vec3f> colors_, d_radiance_;  // albedo of the hits, dL/d(radiance)
  std::vector<Vec3f> directions_;
  std::vector<float> edges_;  // of the hits' normals (sdf_normals)
};

}  // namespace

void polish_surface(const Device& device, GeometryStage& stage, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions& options, Progress& progress) {
  const double start = options.clock();
  Polish polish(device, stage, input, appearance, options, progress);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    const double time = options.seconds > 0 ? (options.clock() - start) / options.seconds : 0;
    if (time >= 1) break;
    polish.step(step, std::max(time, double(step) / options.steps));
    if (options.show) options.show();
    if (step % 20 == 0) progress.report({"surface by its reflections", double(step) / options.steps, -1, ""});
  }
}

}  // namespace cei3d
