// SPDX-License-Identifier: Apache-2.0
// Descent on the material of an object: on the network of roughness and metalness where they vary, else on
// logits of the one material's roughness, specular strength and metalness.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "model/field/adam_constants.h"
#include "model/field/optimizer.h"
#include "model/scene/material_field.h"

namespace cei3d {

class MaterialDescent {
 public:
  // rate: of Adam, on logits; the network has the default rates of FieldTrainer times rate / 1e-2. A
  // metalness of 0 or 1 stays; so does the specular strength unless learn_specular.
  MaterialDescent(const MaterialField& start, float rate, bool learn_specular, AdamConstants adam = {});

  const MaterialField& field() const { return field_; }
  // d_material: #positions, dL/d(material there).
  void accumulate(const Device&, std::span<const Vec3f> positions, std::span<const Material> d_material);
  void update(const Device&, float rate);

  void save(Tensors& out, const std::string& prefix) const;
  void load(const Tensors& in, const std::string& prefix);

 private:
  friend struct JointDescentProbe;
  Material from_logits() const;

  MaterialField field_;
  float rate_;
  std::shared_ptr<Field> varying_;  // null: one material
  std::unique_ptr<FieldTrainer> trainer_;
  ParamSet params_;
  Param* logits_ = nullptr;  // of roughness, specular strength, metalness
  bool learned_[3] = {};
  Optimizer optimizer_;
};

}  // namespace cei3d
