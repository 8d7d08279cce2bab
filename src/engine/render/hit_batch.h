// SPDX-License-Identifier: Apache-2.0
// Hits that are shaded together.
#pragma once

#include <span>
#include <vector>

#include "model/geometry/shape/hit.h"
#include "model/light/light_turns.h"
#include "model/material/material.h"

namespace cei3d {

// Hits, the material of each, and the rotation of a turning light in its view.
struct HitBatch {
  std::span<const Hit> hits;
  std::span<const Material> materials;  // #hits
  TurnedHits turned = {};
  size_t size() const { return hits.size(); }
  HitBatch part(int begin, int end) const {
    const auto first = size_t(begin), n = size_t(end - begin);
    return {hits.subspan(first, n), materials.subspan(first, n), turned.part(first, n)};
  }
};

// Hits that all have the same material.
struct UniformBatch {
  UniformBatch(std::span<const Hit> h, const Material& m) : hits(h), materials(h.size(), m) {}
  operator HitBatch() const { return {hits, materials}; }  // NOLINT: it is one
  std::span<const Hit> hits;
  std::vector<Material> materials;
};

}  // namespace cei3d
