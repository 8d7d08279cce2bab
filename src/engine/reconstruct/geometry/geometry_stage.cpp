// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/geometry_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "core/math/sub_pixel.h"
#include "model/field/sphere_start.h"

namespace cei3d {

GeometryStage::GeometryStage(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
                             uint64_t seed)
    : device_(device),
      pixels_(pixels),
      options_(options),
      seed_(seed),
      sdf_(options.sdf, seed),
      errors_(pixels.pixels().size()),
      work_([this] { return std::make_unique<Work>(options_); }),
      radiance_gradients_(options.rays / kChunkRays) {
  add_mlp_params(radiance_config(options), radiance_, seed + 1);
  const Optimizer::Group layers{.rate = options.layer_rate, .adam = options.adam};
  optimizer_.add(sdf_.params(), "encoding/",
                 {.rate = options.table_rate, .adam = options.adam, .skip_zero = true});
  optimizer_.add(sdf_.params(), "layer", layers);
  optimizer_.add(radiance_, "layer", layers);
}

void GeometryStage::begin_as_sphere(float radius) { cei3d::begin_as_sphere(device_, sdf_, radius, seed_); }

void GeometryStage::prefit(const StartShape& start, const Progress& progress) {
  cei3d::prefit(device_, sdf_, start.distance,
                {options_.prefit_steps, options_.layer_rate, levels_at(0), seed_}, progress);
  anchor_ = start.anchored || options_.hold_start ? start.distance : DistanceGrid{};
  matte_until_ = start.matte_until;
}

GeometryStage::Step GeometryStage::step_at(int64_t index, double u) const {
  GeometrySchedule s = schedule_at(options_, u);
  s.view_dependent = u >= matte_until_;
  if (!anchor_.n) s.anchor = 0;
  return {.index = index,
          .schedule = s,
          .networks = {.device = device_,
                       .sdf = sdf_,
                       .sdf_weights = {mlp_config(options_.sdf), sdf_.params()},
                       .radiance_weights = {radiance_config(options_), radiance_},
                       .levels = levels_at(u)},
          .objective = {options_, s, anchor_}};
}

// Cells near the surface decide where rays are sampled. The others only decide how far rays skip empty space,
// and are updated less often.
void GeometryStage::refresh_grid(int64_t step, double u, const Progress& progress) {
  constexpr int kUpdatesPerFull = 40;
  if (step % options_.refresh_every != 0) return;
  const int updates_per_wide = u >= options_.tight_grid_from ? 10 : 3;
  const int64_t update = step / options_.refresh_every;
  grid_.refresh(device_, sdf_,
                update % kUpdatesPerFull == 0    ? 1e9f
                : update % updates_per_wide == 0 ? 0.15f
                                                 : schedule_at(options_, u).band + grid_.half_diagonal(),
                progress);
}

void GeometryStage::sample_training_rays(const Step& step, int chunk, Work& w) const {
  w.batch = training_rays(pixels_, errors_, {seed_, step.index, chunk * kChunkRays}, kChunkRays);
  turn_light(light_, pixels_, w.batch);
  std::vector<float> jitter;
  for (int r = 0; r < kChunkRays; ++r)
    jitter.push_back(
        Rng(seed_ ^ 0x5eed, uint64_t(step.index) * 4096 + uint64_t(chunk), uint64_t(r)).uniform());
  w.sampler.sample(step.networks, step.schedule, grid_, w.batch, jitter, w.samples);
}

GeometryStats GeometryStage::ray_gradients(const Step& step, int chunk, Work& w,
                                           std::span<PixelError> errors) {
  GeometryStats stats;
  StepTimes::thread(times_, StepPart::march, [&] { sample_training_rays(step, chunk, w); });
  stats.candidates = w.sampler.evaluated();
  StepTimes::thread(times_, StepPart::forward,
                    [&] { w.renderer.forward(step.networks, step.schedule, w.batch, w.samples); });
  StepTimes::thread(times_, StepPart::backward, [&] {
    step.objective.backward(w.batch, w.samples, w.renderer, stats);
    w.renderer.backward_networks(step.networks, w.batch, sdf_gradients_[chunk], radiance_gradients_[chunk]);
  });
  for (int r = 0; r < kChunkRays; ++r) {
    const Vec3f error = w.renderer.pixels()[r] - w.batch.targets[r].srgb;
    errors[r] = {w.batch.pixels[r], dot(error, error)};
  }
  return stats;
}

void GeometryStage::value_gradients(const Step& step, const ValueGradSpans& more, Work& w,
                                    ChunkGradients& g) const {
  w.values.gradient(
      step.networks, more.points, [&](int i, float) { return more.d_values[i]; }, g);
}

GeometryStats GeometryStage::hold_gradients(const Step& step, Work& w, ChunkGradients& g) const {
  constexpr int kPoints = PointValues::kBlock;
  GeometryStats stats;
  const std::vector<Vec3f> x = hold_points(anchor_, seed_, step.index, kPoints);
  const auto d_value = [&](int i, float distance) {
    const LossValue<float> loss = step.objective.hold(x[i], distance, kPoints);
    stats.loss += loss.value;
    return loss.gradient;
  };
  w.values.gradient(step.networks, x, d_value, g);
  return stats;
}

GeometryStats GeometryStage::accumulate(const Step& step, const ValueGradSpans& more) {
  constexpr int kBlock = PointValues::kBlock;
  const int ray_chunks = options_.rays / kChunkRays;
  const int value_chunks = (int(more.points.size()) + kBlock - 1) / kBlock;
  const int hold_chunks = options_.hold_start && step.schedule.anchor > 0;
  const int chunks = ray_chunks + value_chunks + hold_chunks;
  sdf_gradients_.resize(chunks);
  std::vector<GeometryStats> stats(chunks);
  std::vector<PixelError> errors(options_.rays);
  const auto run = [&](int c, Work& w) {
    if (c < ray_chunks) {
      stats[c] = ray_gradients(step, c, w, std::span(errors).subspan(size_t(c) * kChunkRays, kChunkRays));
    } else if (c < ray_chunks + value_chunks) {
      const size_t first = size_t(c - ray_chunks) * kBlock,
                   n = std::min<size_t>(kBlock, more.points.size() - first);
      value_gradients(step, {more.points.subspan(first, n), more.d_values.subspan(first, n)}, w,
                      sdf_gradients_[c]);
    } else {
      stats[c] = hold_gradients(step, w, sdf_gradients_[c]);
    }
  };
  parallel_for(chunks, [&](int c) { work_.with([&](Work& w) { run(c, w); }); });
  for (const PixelError& e : errors) errors_.record(e);
  std::vector<const std::vector<float>*> radiance;
  for (const auto& g : radiance_gradients_) radiance.push_back(&g);
  accumulate_layers(radiance_, radiance, optimizer_);
  StepTimes::process(times_, StepPart::scatter, [&] {
    accumulate_gradients(device_, sdf_, sdf_gradients_, step.networks.levels, optimizer_);
  });
  GeometryStats total;
  for (const GeometryStats& s : stats) total += s;
  return total;
}

GeometryStats GeometryStage::step(int64_t index, double u, const ValueGradSpans& more,
                                  const Progress& progress) {
  StepTimes::process(times_, StepPart::occupancy, [&] { refresh_grid(index, u, progress); });
  const GeometryStats stats = accumulate(step_at(index, u), more);
  StepTimes::process(times_, StepPart::adam, [&] { optimizer_.step(device_, rate_at(options_, u)); });
  return stats;
}

void GeometryStage::render(const Step& step, RayBatch batch, Work& w) const {
  w.batch = std::move(batch);
  const std::vector<float> jitter(w.batch.rays.size(), 0.5f);
  w.sampler.sample(step.networks, step.schedule, grid_, w.batch, jitter, w.samples);
  w.renderer.forward(step.networks, step.schedule, w.batch, w.samples);
}

GeometryStats GeometryStage::evaluate(const PixelStore& held_out, int rays, double u) {
  const Step step = step_at(-1, u);
  const int chunks = rays / kChunkRays;
  std::vector<GeometryStats> stats(chunks);
  parallel_for(chunks, [&](int c) {
    work_.with([&](Work& w) {
      RayBatch rays = random_rays(held_out, {seed_, step.index, c * kChunkRays}, kChunkRays);
      turn_light(light_, held_out, rays);
      render(step, std::move(rays), w);
      for (int r = 0; r < w.batch.count(); ++r) {
        const Vec3f e = w.renderer.pixels()[r] - w.batch.targets[r].srgb;
        stats[c].squared_error += dot(e, e) / 3;
        ++stats[c].rays;
      }
    });
  });
  GeometryStats total;
  for (const GeometryStats& s : stats) total += s;
  return total;
}

template <class F>
void GeometryStage::render_rays(const Camera& camera, int samples, const F& take) {
  const int per_pixel = samples * samples, pixels = kChunkRays / per_pixel,
            all = camera.width * camera.height;
  if (pixels < 1)
    fail("A view of the model has at most 8 samples per pixel and axis (an error in the program).");
  const Step step = step_at(-1, 1);
  parallel_for((all + pixels - 1) / pixels, [&](int c) {
    std::vector<Ray> rays;
    for (int i = c * pixels; i < std::min(all, (c + 1) * pixels); ++i)
      for (int k = 0; k < per_pixel; ++k) {
        const Vec2f at = sub_pixel(k, samples);
        rays.push_back(camera.ray(i % camera.width + at.x, i / camera.width + at.y));
      }
    work_.with([&](Work& w) {
      RayBatch batch = view_rays(std::move(rays));
      if (light_.motion != LightMotion::world)
        batch.room_from_object.assign(batch.rays.size(), light_.room_from_object(camera.world_from_cam));
      render(step, std::move(batch), w);
      for (int r = 0; r < w.batch.count(); ++r) take(c * pixels + r / per_pixel, r, w);
    });
  });
}

Image GeometryStage::render_radiance(const Camera& camera, int samples) {
  Image out(camera.width, camera.height, 3);
  const float share = 1.0f / float(samples * samples);
  render_rays(camera, samples, [&](int pixel, int ray, const Work& w) {
    for (int k = 0; k < 3; ++k)
      out.data[size_t(pixel) * 3 + size_t(k)] += w.renderer.pixels()[ray][k] * share;
  });
  return out;
}

ModelView GeometryStage::render_view(const Camera& camera) {
  ModelView out{Image(camera.width, camera.height, 3), Image(camera.width, camera.height, 1)};
  render_rays(camera, 1, [&](int pixel, int ray, const Work& w) {
    for (int k = 0; k < 3; ++k) out.srgb.data[size_t(pixel) * 3 + size_t(k)] = w.renderer.pixels()[ray][k];
    out.depth.data[size_t(pixel)] = w.renderer.depths()[ray];
  });
  return out;
}

namespace {

std::vector<float> values_of(const LightFrame& f) {
  std::vector<float> out{float(f.motion), f.axis.x, f.axis.y, f.axis.z};
  for (const Vec3f& row : f.reference.row) out.insert(out.end(), {row.x, row.y, row.z});
  for (const CameraRing& r : f.rings)
    out.insert(out.end(), {r.axis.x, r.axis.y, r.axis.z, r.forward, r.right});
  return out;
}
LightFrame light_frame_from(const std::vector<float>& v) {
  constexpr size_t kRings = 13, kRing = 5;  // first value of the rings, and their lengths
  if (v.size() < kRings || (v.size() - kRings) % kRing != 0) fail("The frame of the light is incomplete.");
  const auto vec = [&](size_t i) { return Vec3f{v[i], v[i + 1], v[i + 2]}; };
  LightFrame f{LightMotion(int(v[0])), vec(1), {{vec(4), vec(7), vec(10)}}};
  for (size_t i = kRings; i < v.size(); i += kRing) f.rings.push_back({vec(i), v[i + 3], v[i + 4]});
  return f;
}

}  // namespace

void GeometryStage::save(Tensors& out) const {
  sdf_.params().save(out, "sdf");
  radiance_.save(out, "radiance");
  optimizer_.save(out, "adam");
  const int64_t n = grid_.resolution();
  out["pixel_errors"] = {{int64_t(errors_.block_errors().size())}, errors_.block_errors(), {}};
  out["matte_until"] = {{1}, {matte_until_}, {}};
  const std::vector<float> light = values_of(light_);
  out["light_frame"] = {{int64_t(light.size())}, light, {}};
  if (anchor_.n) out["anchor"] = {{anchor_.n, anchor_.n, anchor_.n}, anchor_.values, {}};
  // With cells that are out of date, so that a resumed run equals one that never stopped.
  out["occupancy"] = {{n, n, n}, grid_.values(), {}};
}

void GeometryStage::load(const Tensors& in) {
  sdf_.params().load(in, "sdf");
  radiance_.load(in, "radiance");
  optimizer_.load(in, "adam");
  const int64_t n = grid_.resolution();
  grid_.set(require_tensor(in, "occupancy", {n, n, n}).f32);
  errors_.set_block_errors(require_tensor(in, "pixel_errors", {int64_t(errors_.block_errors().size())}).f32);
  matte_until_ = require_tensor(in, "matte_until", {1}).f32[0];
  if (in.contains("light_frame")) light_ = light_frame_from(require_tensor(in, "light_frame").f32);
  if (const auto anchor = in.find("anchor"); anchor != in.end() && !anchor->second.shape.empty()) {
    const int64_t cells = anchor->second.shape[0];
    anchor_ = {int(cells), require_tensor(in, "anchor", {cells, cells, cells}).f32};
  }
}

}  // namespace cei3d
