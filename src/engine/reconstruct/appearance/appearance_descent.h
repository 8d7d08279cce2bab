// SPDX-License-Identifier: Apache-2.0
// Descent on the albedo field under a fixed light, then on albedo, material and light together.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/light_descent.h"
#include "engine/reconstruct/appearance/relit_object.h"
#include "engine/render/lighting.h"

namespace cei3d {

// The two parts of the descent, one after the other. Rates are shares of the full rates at the beginning of a
// part, at whose end they are a tenth of that.
struct DescentSchedule {
  int albedo = 0;                // steps on the albedo alone
  int refine = 0;                // steps on albedo, material and light together
  float albedo_rate = 1;         // rate of the albedo while it descends alone
  float refine_albedo_rate = 1;  // rate of the albedo while all descend together
  bool keep_power = false;       // see LightDescent
};

class AppearanceDescent {
 public:
  // result: holds the light and material to begin with, and gets those that the descent reaches. bouncing:
  // #V, the albedo by which bounces are computed while the albedo descends alone. Afterwards it is the
  // field's own.
  AppearanceDescent(const Device&, const AppearanceInput&, std::shared_ptr<const Transport>,
                    const AppearanceOptions&, Field albedo, const std::vector<Vec3f>& bouncing,
                    AppearanceResult& result, Progress&);

  // Error: interrupted, after its state was stored.
  void run(const DescentSchedule&, const DescentStore&);
  Field take_albedo() { return std::move(albedo_); }

 private:
  friend struct AppearanceDescentProbe;  // the gradient test sees a batch and its gradient
  void fit_albedo(const DescentSchedule&, const DescentStore&);
  void refine(const DescentSchedule&, const DescentStore&);
  void between_steps(const DescentStore&, const char* what, double done) const;
  void learn_materials(const Field&);
  void relight(std::vector<Vec3f> albedo);
  void light_up();
  void choose_batch();
  // The loss of the batch, for the training of the albedo; sets pixel_albedo_ and d_radiance_. terms: of the
  // batch, must outlive the loss.
  FieldTrainer::Loss pixel_loss(const std::vector<ShadingTerms<float>>& terms);
  void refine_step(float rate, float albedo_rate);
  DescentState state() const;
  void load(const DescentState&, const DescentSchedule&);

  const Device& device_;
  const AppearanceInput& input_;
  std::shared_ptr<const Transport> transport_;
  AppearanceOptions options_;
  AppearanceResult& result_;
  Progress& progress_;
  Field albedo_;
  FieldTrainer albedo_trainer_;
  std::shared_ptr<Field> materials_;  // null: one material, held constant
  std::unique_ptr<FieldTrainer> material_trainer_;
  std::optional<LightDescent> light_;  // while all descend

  RelitObject relit_;
  std::unique_ptr<Lighting> lighting_;

  int64_t step_ = 0;  // steps that are done, of both descents
  std::vector<uint32_t> batch_;
  std::vector<Vec3f> points_;                     // kPixelPoints of each pixel
  std::vector<Vec3f> pixel_albedo_, d_radiance_;  // of the batch
};

}  // namespace cei3d
