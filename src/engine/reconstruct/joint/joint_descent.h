// SPDX-License-Identifier: Apache-2.0
// The joint descent: one hit per ray; distance field, albedo, material and light descend together on the
// color of pixels, the unit slope of the field and the mask. [paper eq. 6-16; docs/method.md#joint-descent]
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/progress.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/light_descent.h"
#include "engine/reconstruct/appearance/relit_object.h"
#include "engine/reconstruct/joint/material_descent.h"
#include "engine/reconstruct/joint/sg_shading.h"
#include "engine/reconstruct/joint/traced_hits.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/rate_schedule.h"
#include "engine/render/lighting.h"
#include "model/field/adam_constants.h"
#include "model/field/weight_norm.h"

namespace cei3d {

enum class ColorLoss {
  display,  // Huber loss of display-encoded colors
  linear    // L1 of linear colors, as in the paper
};

enum class SpecularTerm {
  split_sum,  // that of the shading model (core/math/shading.h)
  single_sg   // one spherical Gaussian, without occlusion or self reflection (sg_shading.h)
};

// Learning rates of Adam at the beginning. 0: held constant.
struct JointRates {
  float sdf_tables = 1e-4f, sdf_layers = 5e-5f;
  float albedo = 0.05f;    // factor of the appearance stage's rates: 1e-2 of tables, 2e-3 of layers
  float material = 1e-3f;  // rate of logits, see MaterialDescent
  float light = 0.3f;      // factor of LightDescent's rates: 1e-2 of logarithms, 2e-3 of axes
};

struct JointOptions {
  JointRates rates;
  RateSchedule schedule;
  AdamConstants adam;
  bool weight_norm = false;  // normalize the distance field's weights; its hash tables then stay as they are
  ColorLoss color = ColorLoss::display;
  SpecularTerm specular = SpecularTerm::split_sum;
  int rays = 4096;             // rays through pixels of the object, per step
  float eikonal = 0.1f;        // weight of the eikonal loss, (|gradient| - 1)^2 [paper eq. 16]
  int box_points = 1024;       // random points of the object's box with the eikonal loss, per step
  int near_points = 1024;      // random points near hits with the eikonal loss, per step
  int mask_rays = 1024;        // rays around the object with the mask loss, per step
  float mask = 0.1f;           // weight of the mask loss, per mask_sharpness
  float mask_sharpness = 800;  // sharpness of the mask loss, 1 / length
  bool keep_power = true;      // keep the power of the light, see LightDescent
  bool learn_specular = false;
  int refresh = 100;  // steps after which visibility and bounces are recomputed
  uint64_t seed = 1;
};

struct JointObject {
  Field sdf, albedo;
  MaterialField material;
  SgMixture light;
  // The material of SpecularTerm::single_sg; none: it begins as that of `material`. While it is trained,
  // `material` is its nearest_material().
  std::optional<SgMaterial> gloss = {};
};

// The losses of a step: means over its rays or points, times the weights of the losses.
struct JointLoss {
  double color = 0, eikonal = 0, mask = 0;
  double total() const { return color + eikonal + mask; }
};

// Every kHeldOutStride-th sample is not descended on, so that it can judge the result.
inline constexpr size_t kHeldOutStride = 20;

class JointDescent {
 public:
  // input: a surface and its hits; visibility and bounces are computed on this surface throughout. Or no
  // surface and object_rays(): these are traced through the field alone, and hits are lit as if the object
  // hid nothing from itself. pixels: the mask loss takes rays through those that do not show the object. All
  // must outlive the descent.
  JointDescent(const Device&, const AppearanceInput& input, const PixelStore& pixels, JointObject start,
               const JointOptions&, const Progress&);

  // rate: factor of all rates.
  JointLoss step(int step, float rate);
  const JointObject& object() const { return object_; }
  const Lighting& lighting() const { return *lighting_; }  // of the last step
  // PSNR (dB, display-encoded) of the descent's own shading on held-out samples, fewer than 40,000 of them.
  // Rays that miss the surface are black.
  double held_out_psnr();

  // The object, the moments of its optimizers, and what visibility and bounces were computed from. A descent
  // that is loaded from them continues as if it had not been interrupted.
  void save(Tensors& out) const;
  void load(const Tensors& in);

 private:
  friend struct JointDescentProbe;  // the gradient test sees gradients before they are used
  struct Shaded {                   // the hits of a step, and dL/d(all that their radiance depends on)
    std::vector<Hit> hits;
    std::vector<Material> materials;
    std::vector<uint16_t> views;
    ShadingGrads grads{0};
  };
  // Accumulates the gradients of a step.
  JointLoss accumulate(int step, Shaded& shaded);
  void update(const Shaded&, float rate);

  void relight();
  void light_up();  // from relit_
  std::vector<IncidentLight<float>> light_at(const HitBatch&) const;
  std::vector<ShadingTerms<float>> terms_at(const HitBatch&, const std::vector<IncidentLight<float>>&);
  void make_gloss();
  Ray empty_ray(int step, int i) const;
  std::vector<uint32_t> choose_samples(int step) const;
  double accumulate_color(const TracedHits&, const std::vector<uint32_t>& samples, Shaded&, ValueGrads&);
  double color_loss(uint32_t sample, Vec3f radiance, Vec3f& d_radiance) const;
  HitBatch batch_of(const Shaded&) const;
  std::vector<float> depth_grads(const TracedHits&, std::span<const float> footprints,
                                 const ShadingGrads&) const;
  double accumulate_mask(int step, const std::vector<Ray>& missed, ValueGrads&) const;
  double accumulate_eikonal(int step, const TracedHits&);

  const Device& device_;
  const AppearanceInput& input_;
  const PixelStore& pixels_;
  JointOptions options_;
  JointObject object_;
  FieldTrainer sdf_trainer_, albedo_trainer_;
  std::optional<WeightNorm> sdf_norm_;  // of the distance field
  MaterialDescent material_;
  LightDescent light_;
  std::unique_ptr<SgShading> gloss_;    // null: split sum
  std::optional<Transport> transport_;  // none without a surface
  std::optional<RelitObject> relit_;    // none without a surface, and before the first step
  std::unique_ptr<Lighting> lighting_;
  std::vector<uint32_t> empty_;  // pixels without any object
  Vec3f box_min_, box_max_;      // of the object
};

}  // namespace cei3d
