// SPDX-License-Identifier: Apache-2.0
// What a descent last computed visibility, bounces and reflections from. They are made again from it when the
// descent is resumed, between two refreshes, too.
#pragma once

#include <memory>
#include <vector>

#include "core/base/tensors.h"
#include "engine/render/lighting.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"

namespace cei3d {

struct RelitObject {
  std::vector<Vec3f> albedo;        // #V
  std::vector<Material> materials;  // #V
  SgMixture light;

  std::unique_ptr<Lighting> lighting(const Device&, const std::shared_ptr<const Surface>&, const Transport&,
                                     const LightTurns*) const;
  void save(Tensors& out) const;
  // Error: other numbers of vertices or lobes.
  static RelitObject load(const Tensors&, size_t vertices, size_t lobes);
  static bool is_in(const Tensors&);
};

}  // namespace cei3d
