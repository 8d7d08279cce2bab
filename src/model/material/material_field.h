// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

// The material of every surface point, before edits. So far it is the same everywhere.
class MaterialField {
 public:
  MaterialField() = default;
  MaterialField(const Material& everywhere)
      : everywhere_(everywhere) {}  // NOLINT: one material is a field, too

  // points: of the reconstructed shape, unit frame. #points
  std::vector<Material> at(std::span<const Vec3f> points) const { return {points.size(), everywhere_}; }
  // For reports, and for surface that edits have added.
  const Material& mean() const { return everywhere_; }

 private:
  Material everywhere_;
};

}  // namespace cei3d
