// SPDX-License-Identifier: Apache-2.0
// The reconstructed material, as a function of the place on the surface.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/field/field.h"
#include "model/material/material.h"

namespace cei3d {

// The material of every surface point, before edits: the same everywhere, or roughness and metalness of a
// network. The specular strength is the same everywhere.
class MaterialField {
 public:
  static constexpr int kOutputs = 2;  // roughness and metalness, each in [0, 1]; see material_of()

  MaterialField() = default;
  MaterialField(const Material& everywhere)  // NOLINT: one material is a field, too
      : mean_(everywhere) {}
  // mean: over the reconstructed surface. varying: kOutputs outputs in [0, 1], or more, which are not read.
  MaterialField(const Material& mean, std::shared_ptr<const Field> varying)
      : mean_(mean), varying_(std::move(varying)) {}

  // points: of the reconstructed shape, unit frame. #points
  std::vector<Material> at(const Device&, std::span<const Vec3f> points) const;
  // Mean over the reconstructed surface: for reports, and for surface that edits have added.
  const Material& mean() const { return mean_; }
  // Null: the material is the same everywhere.
  const std::shared_ptr<const Field>& varying() const { return varying_; }

  bool operator==(const MaterialField&) const = default;  // the same network, not an equal one

 private:
  Material mean_;
  std::shared_ptr<const Field> varying_;
};

// The material that the outputs of a network stand for. A metalness near 0 or 1 is clamped to it, so that
// most of a surface is exactly a dielectric or exactly a metal.
Material material_of(const float* outputs, float specular);
// dL/d(outputs) from dL/d(material); 0 where the metalness is clamped.
void material_of_grad(const float* outputs, const Material& d_material, float* d_outputs);
// For the training of a network of kOutputs outputs. d_material: dL/d(material) at the points; must outlive
// it.
FieldTrainer::Loss material_loss(std::span<const Material> d_material);
// Network outputs [kOutputs] that stand for a material; inverse of material_of().
void outputs_for(const Material&, float* outputs);

}  // namespace cei3d
