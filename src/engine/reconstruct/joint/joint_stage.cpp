// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/joint_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "engine/render/render.h"

namespace cei3d {
namespace {

constexpr float kBehind = 2.5f;  // rays of samples begin so far before them: outside the unit sphere

// Reports and logs the mean losses of every few steps.
class Summary {
 public:
  explicit Summary(Progress& progress) : progress_(progress) {}
  void add(const JointLoss& loss, int step, double u) {
    sum_.color += loss.color, sum_.eikonal += loss.eikonal, sum_.mask += loss.mask;
    if (++summed_ < kSteps) return;
    progress_.report({"joint descent", u, -1, ""});
    progress_.log(Json{{"stage", "joint descent"},
                       {"step", step},
                       {"color", sum_.color / summed_},
                       {"eikonal", sum_.eikonal / summed_},
                       {"mask", sum_.mask / summed_}}
                      .dump());
    sum_ = {};
    summed_ = 0;
  }

 private:
  static constexpr int kSteps = 50;
  Progress& progress_;
  JointLoss sum_;
  int summed_ = 0;
};

}  // namespace

JointObject descend_jointly(const Device& device, const AppearanceInput& input, const PixelStore& pixels,
                            JointObject start, const JointStageOptions& options, Progress& progress) {
  const double begin = options.clock() - options.spent;
  progress.report({"joint descent", 0, -1, ""});
  JointDescent descent(device, input, pixels, std::move(start), options.descent, progress);
  const DescentStore& store = options.store;
  if (!store.from.tensors.empty()) descent.load(store.from.tensors);
  Summary summary(progress);
  for (int step = int(store.from.step); step < options.steps; ++step) {
    store.between_steps(progress, [&] {
      DescentState state{step, {}};
      descent.save(state.tensors);
      return state;
    });
    const double time = options.seconds > 0 ? (options.clock() - begin) / options.seconds : 0,
                 u = std::max(time, double(step) / options.steps);
    if (u >= 1) break;
    const JointLoss loss = descent.step(step, float(rate_at(options.descent.schedule, u, options.steps)));
    if (!std::isfinite(loss.total()))
      fail("The joint descent diverged at step {}: the loss is not a number.", step);
    if (options.show) options.show(descent.lighting(), descent.object().albedo, descent.object().material);
    summary.add(loss, step, u);
  }
  progress.log(Json{{"stage", "joint descent"}, {"held_out_psnr", descent.held_out_psnr()}}.dump());
  return descent.object();
}

double held_out_psnr(const Device& device, const Scene& scene, const SurfaceSamples& samples,
                     const Progress& progress) {
  std::vector<uint32_t> judged;
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < samples.hits.size(); i += uint32_t(kHeldOutStride)) {
    const Hit& h = samples.hits[i];
    judged.push_back(i);
    rays.push_back({h.position + h.to_camera * kBehind, -h.to_camera});
  }
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, *scene.sdf, *scene.surface, rays, ray_of_hit);
  std::vector<float> footprints;
  std::vector<uint32_t> met;
  for (const uint32_t ray : ray_of_hit) {
    met.push_back(judged[ray]);
    if (!samples.footprints.empty()) footprints.push_back(samples.footprints[judged[ray]]);
  }
  const std::vector<uint16_t> views = views_of(samples.turned, met);
  const std::vector<Vec3f> radiance =
      radiance_of(device, scene, {hits, {}, {}, footprints, {samples.turned.turns, views}}, progress);
  std::vector<Vec3f> of_judged(judged.size(), Vec3f{0, 0, 0});
  for (size_t k = 0; k < radiance.size(); ++k) of_judged[ray_of_hit[k]] = radiance[k];
  return display_psnr(samples, judged, of_judged);
}

}  // namespace cei3d
