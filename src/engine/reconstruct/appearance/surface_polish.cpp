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
         const AppearanceResult& appearance, const PolishOptions& options)
      : device_(device),
        stage_(stage),
        samples_(input.samples),
        appearance_(appearance),
        options_(options),
        albedo_(*appearance.albedo),
        trainer_(albedo_, {}),
        lighting_(device, input.surface, appearance.light, vertex_colors(input.surface),
                  appearance.material) {}

  // share: of the polishing that is done, [0, 1).
  GeometryStats step(int step, double share) {
    choose_batch(step);
    refine_hits(device_, stage_.sdf(), directions_, hits_, edges_);
    const HitLight light = lighting_.light_at(hits_);
    fit_albedo(light);
    std::vector<Vec3f> d_normals = lighting_.normal_slopes(hits_, light, colors_, d_radiance_), positions,
                       points;
    std::vector<float> d_values;
    for (Vec3f& d : d_normals) d = d * options_.weight;
    for (const Hit& h : hits_) positions.push_back(h.position);
    add_value_slopes(stage_.sdf().config(), positions, d_normals, edges_, points, d_values);
    return stage_.step(options_.first_step + step, options_.from + (1 - options_.from) * share,
                       {points, d_values});
  }

 private:
  std::vector<Vec3f> vertex_colors(const Surface& surface) const {
    const auto& x = surface.mesh().positions;
    std::vector<float> values(3 * x.size());
    albedo_.eval(device_, x, values);
    std::vector<Vec3f> out(x.size());
    for (size_t i = 0; i < x.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return out;
  }

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

  // One step of the albedo, so that what it had learnt of wrong normals does not hold them. Sets colors_ and
  // d_radiance_.
  void fit_albedo(const HitLight& light) {
    std::vector<Vec3f> positions(hits_.size());
    for (size_t i = 0; i < hits_.size(); ++i) positions[i] = hits_[i].position;
    colors_.resize(hits_.size());
    d_radiance_.resize(hits_.size());
    const auto loss = [&](int begin, int end, const float* out, float* d_out) {
      for (int i = begin; i < end; ++i) {
        const float* a = out + 3 * (i - begin);
        const HitLight::Terms t = light.at(i, appearance_.material);
        const uint32_t sample = batch_[i];
        for (int c = 0; c < 3; ++c) {
          const float gain = t.diffuse_gain[c] + t.specular_gain[c], got = t.specular_floor[c] + a[c] * gain;
          const float g =
              display_loss_slope(got, samples_.colors[sample][c], samples_.is_clipped(sample, c)) /
              float(options_.batch);
          d_radiance_[i][c] = g;
          colors_[i][c] = a[c];
          d_out[3 * (i - begin) + c] = g * gain;
        }
      }
    };
    trainer_.step(device_, positions, loss, 0.1f);
  }

  const Device& device_;
  GeometryStage& stage_;
  SurfaceSamples samples_;
  const AppearanceResult& appearance_;
  PolishOptions options_;
  Field albedo_;
  FieldTrainer trainer_;
  Lighting lighting_;
  std::vector<uint32_t> batch_;
  std::vector<Hit> hits_;
  std::vector<Vec3f> colors_, d_radiance_;  // base colour of the hits, dL/d(what they send out)
  std::vector<Vec3f> directions_;
  std::vector<float> edges_;  // of the hits' normals (sdf_normals)
};

}  // namespace

void polish_surface(const Device& device, GeometryStage& stage, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions& options, Progress& progress) {
  const double start = options.clock();
  Polish polish(device, stage, input, appearance, options);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    const double time = options.seconds > 0 ? (options.clock() - start) / options.seconds : 0;
    if (time >= 1) break;
    polish.step(step, std::max(time, double(step) / options.steps));
    if (step % 20 == 0) progress.report({"surface by its reflections", double(step) / options.steps, -1, ""});
  }
}

}  // namespace cei3d
