// SPDX-License-Identifier: Apache-2.0
// The geometry stage: a signed distance field is trained by volume rendering together with a small radiance
// network, which is thrown away afterwards. [paper sec. 4.1]
#pragma once

#include <span>

#include "core/base/pool.h"
#include "core/base/progress.h"
#include "engine/reconstruct/geometry/geometry_objective.h"
#include "engine/reconstruct/geometry/geometry_options.h"
#include "engine/reconstruct/geometry/model_view.h"
#include "engine/reconstruct/geometry/occupancy.h"
#include "engine/reconstruct/geometry/pixel_errors.h"
#include "engine/reconstruct/geometry/point_values.h"
#include "engine/reconstruct/geometry/ray_sampler.h"
#include "engine/reconstruct/geometry/step_times.h"
#include "engine/reconstruct/geometry/volume_renderer.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/start/prefit.h"
#include "model/field/field.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"

namespace cei3d {

// A loss of the field's distances at points of the caller's choice, by its derivatives.
struct ValueGradSpans {
  std::span<const Vec3f> points;
  std::span<const float> d_values;  // #points: derivative of the loss by the distance there
};

struct StartShape {
  DistanceGrid distance;
  // The shape has hollows that no mask shows: the surface is held there until the radiance network has
  // learned colors, which would fill them again before.
  bool anchored = false;
  // Position in the schedule until which colors do not depend on the view, so that only the surface can
  // explain what changes with it.
  float matte_until = 0;
};

class GeometryStage {
 public:
  GeometryStage(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
                uint64_t seed);

  // The radiance network gets normals in the frame of this light from now on.
  void set_light(const LightFrame& frame) { light_ = frame; }
  void begin_as_sphere(float radius);
  // Fits the field to a shape: descent then starts from the right object. Error: it is empty.
  void prefit(const StartShape&, const Progress& progress = Progress());
  // One training step at schedule position u in [0, 1). Error: interrupted, before anything has changed.
  GeometryStats step(int64_t step, double u, const ValueGradSpans& more = {},
                     const Progress& progress = Progress());
  // Loss statistics of random pixels of another store (held-out views), no training.
  GeometryStats evaluate(const PixelStore& held_out, int rays, double u);
  // The whole view by the radiance field, over white, display-encoded RGB. samples: per pixel and axis.
  Image render_radiance(const Camera& unit_camera, int samples);
  // The view of render_radiance() and its depths, by one sample a pixel.
  ModelView render_view(const Camera& unit_camera);

  const Field& sdf() const { return sdf_; }
  void time_into(StepTimes* times) { times_ = times; }  // null: no clock is read
  int levels_at(double u) const { return cei3d::levels_at(options_, u); }
  void save(Tensors& out) const;
  void load(const Tensors& in);

 private:
  friend struct GeometryStageProbe;  // the gradient test sees samples and gradients
  struct Work {                      // memory of one task
    explicit Work(const GeometryOptions& o) : sampler(o.sdf, o.sampling), renderer(o), values(o.sdf) {}
    RayBatch batch;
    RaySamples samples;
    RaySampler sampler;
    VolumeRenderer renderer;
    PointValues values;
  };
  struct Step {  // what all tasks of a step share and none of them changes
    int64_t index;
    GeometrySchedule schedule;
    GeometryNetworks networks;
    GeometryObjective objective;
  };
  Step step_at(int64_t index, double u) const;
  void refresh_grid(int64_t step, double u, const Progress&);
  // Adds the gradients of the loss to the optimizer's and records the errors of pixels.
  GeometryStats accumulate(const Step&, const ValueGradSpans& more);
  void sample_training_rays(const Step&, int chunk, Work&) const;
  GeometryStats ray_gradients(const Step&, int chunk, Work&, std::span<PixelError> errors);
  void value_gradients(const Step&, const ValueGradSpans&, Work&, ChunkGradients&) const;
  GeometryStats hold_gradients(const Step&, Work&, ChunkGradients&) const;
  void render(const Step&, RayBatch, Work&) const;
  // take(pixel, ray, work): of each ray of the view, `samples` per pixel and axis.
  template <class F>
  void render_rays(const Camera&, int samples, const F& take);

  const Device& device_;
  const PixelStore& pixels_;
  GeometryOptions options_;
  uint64_t seed_;
  Field sdf_;
  ParamSet radiance_;
  Optimizer optimizer_;
  OccupancyGrid grid_;
  PixelErrors errors_;
  DistanceGrid anchor_;  // the start shape, if it is held; else empty
  float matte_until_ = 0;
  LightFrame light_;
  Pool<Work> work_;
  StepTimes* times_ = nullptr;
  std::vector<ChunkGradients> sdf_gradients_;  // of the current step, by task
  std::vector<std::vector<float>> radiance_gradients_;
};

}  // namespace cei3d
