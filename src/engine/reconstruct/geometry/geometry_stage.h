// SPDX-License-Identifier: Apache-2.0
// The geometry stage (EIR): volume rendering of the signed distance field with a small radiance network,
// until the surface stands. [paper sec. 3 and 4.1; docs/method.md#geometry-stage]
#pragma once

#include <memory>
#include <span>

#include "core/base/pool.h"
#include "engine/reconstruct/geometry/occupancy.h"
#include "engine/reconstruct/geometry/pixel_errors.h"
#include "engine/reconstruct/geometry/step_times.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/start/prefit.h"
#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"

namespace cei3d {

struct GeometryOptions {
  FieldConfig sdf;  // outputs: 1 + features
  int radiance_layers = 2, radiance_width = 64;
  int rays = 2048;  // a step
  float sharpness_start = 200,
        sharpness_end = 800;     // of the logistic density, geometric over `sharpness_until`
  float sharpness_until = 0.6f;  // fractions of the schedule
  float unlock_until = 0.3f;     // hash levels open, coarse to fine, until here
  int first_levels = 5;
  // Along rays, unit-sphere units; in between step_width / sharpness. The opacity of a step is exact for any
  // length, and jitter sees to what colours a longer one misses.
  float step_min = 0.006f, step_max = 0.02f, step_width = 2.5f;
  float keep_weight = 0.003f;  // samples below it get no jet and no radiance
  float huber_width = 0.05f, eikonal_weight = 0.3f;
  float empty_weight = 0.1f;                     // of empty_push(), times the sharpness
  float table_rate = 3e-3f, layer_rate = 2e-3f;  // Adam
  float decay_from = 0.3f, decay_to = 0.01f;  // exponential decay of the rate over the rest of the schedule
  int prefit_steps = 300;
  int refresh_every = 10;   // steps between looks at the occupancy grid
  float rests_from = 0.4f;  // the surface: from here on the grid is trusted more closely
  bool hold_start = false;  // hold every start, not only those that are anchored, and all around its surface
  float anchor_until = 0.2f;  // such a start holds the surface, less and less, until here: colours that know
  float anchor_weight = 0.15f;  // nothing yet would blow it up again. Times the sharpness
};

struct GeometryStats {
  double color = 0, mask = 0, eikonal = 0;  // losses, a ray
  double squared_error = 0;                 // a ray and channel, display space
  int64_t kept = 0, candidates = 0, rays = 0;
  double psnr() const;
};

// A loss that somebody else has for the field's values at points of his own: they, and its slopes there.
struct ValueSlopes {
  std::span<const Vec3f> points;
  std::span<const float> slopes;  // #points
};

// What descent starts from. anchored: it shows hollows that no mask does; they are held open until colours
// mean something.
struct StartShape {
  DistanceGrid distance;
  bool anchored = false;
  // Until this fraction of the schedule colours do not depend on the view, so that what moves with it must be
  // the surface.
  float matte_until = 0;
};

class GeometryStage {
 public:
  GeometryStage(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
                uint64_t seed);

  ~GeometryStage();

  // Fits the field to a shape: descent then starts from the right object. Error: it is empty.
  void prefit(const StartShape&);
  // One training step at schedule position u in [0, 1).
  GeometryStats step(int64_t step, double u, const ValueSlopes& more = {});
  // Loss statistics of random pixels of another store (held-out views), no training.
  GeometryStats evaluate(const PixelStore& held_out, int rays, double u);
  // The whole view by the radiance field, over white, display-encoded RGB. samples: a pixel and axis.
  Image render_radiance(const Camera& unit_camera, int samples);

  const Field& sdf() const { return sdf_; }
  void time_into(StepTimes* times) { times_ = times; }  // null: no clock is read
  int levels_at(double u) const;
  void save(Tensors& out) const;
  void load(const Tensors& in);

 private:
  struct Work;      // buffers of one chunk of rays
  struct RayBatch;  // its rays and targets
  struct Schedule {
    float sharpness, step, band;
    float slack;  // of the occupancy grid
    int levels;
    bool views;    // colours depend on the view
    float anchor;  // weight of the start shape
  };
  Schedule schedule_at(double u) const;
  void sample_rays(const PixelStore&, int64_t step, int first, bool training, RayBatch&) const;
  void find_values(const Schedule&, const RayBatch&, std::span<const int> candidates, Work&) const;
  void gather_samples(const Schedule&, const RayBatch&, Work&, uint64_t jitter_key, bool training) const;
  void forward(const Schedule&, const RayBatch&, Work&) const;
  void backward(const Schedule&, const RayBatch&, Work&, ChunkGradients& sdf, std::vector<float>& radiance,
                GeometryStats&) const;
  // Gradients of a loss of values at x, whose slope there is slope_of(i, value).
  template <class SlopeOf>
  void add_slopes(const Schedule&, std::span<const Vec3f> x, const SlopeOf& slope_of, Work&,
                  ChunkGradients&) const;
  bool rests_at(double u) const { return u >= options_.rests_from; }
  void refresh_grid(const Schedule&, int64_t step, double u);
  void hold_start(const Schedule&, int64_t step, Work&, ChunkGradients&) const;
  void composite(const Schedule&, const RayBatch&, Work&) const;

  const Device& device_;
  const PixelStore& pixels_;
  GeometryOptions options_;
  uint64_t seed_;
  Field sdf_;
  MlpConfig radiance_config_;
  ParamSet radiance_;
  Optimizer optimizer_;
  OccupancyGrid grid_;
  PixelErrors errors_;
  DistanceGrid anchor_;  // the start shape, if it holds the surface; else empty
  float matte_until_ = 0;
  std::unique_ptr<MlpWeights> sdf_weights_, radiance_weights_;  // of the current step
  Pool<Work> work_;
  StepTimes* times_ = nullptr;
  std::vector<ChunkGradients> sdf_gradients_;
  std::vector<std::vector<float>> radiance_gradients_;
};

}  // namespace cei3d
