// SPDX-License-Identifier: Apache-2.0
// What an edit puts in place of a material or a base color.
#pragma once

#include <optional>

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

struct MaterialChange {
  std::optional<float> roughness, specular, metalness;  // none: what lies below stays
  bool empty() const { return !roughness && !specular && !metalness; }
};

inline Material changed(Material m, const MaterialChange& c) {
  return {c.roughness.value_or(m.roughness), c.specular.value_or(m.specular),
          c.metalness.value_or(m.metalness)};
}

// Another base color, with or without the texture that lies below it. All linear.
struct Tint {
  Vec3f color;
  bool keep_texture = true;  // what lies below, scaled per channel so that its mean becomes `color`
  Vec3f mean{1, 1, 1};       // of what lies below, over the region, when the edit was made
};

inline Vec3f tinted(const Tint& t, Vec3f below) {
  if (!t.keep_texture) return t.color;
  constexpr float kDark = 1e-3f;  // of a channel that has nothing to scale
  Vec3f out;
  for (int c = 0; c < 3; ++c) out[c] = min(below[c] * t.color[c] / max(t.mean[c], kDark), 1.0f);
  return out;
}

}  // namespace cei3d
