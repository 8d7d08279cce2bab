// SPDX-License-Identifier: Apache-2.0
// What an edit puts in place of a material or an albedo.
#pragma once

#include <optional>

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

// `wanted` for a share of [0, 1], the rest being `below`. Exact (bit for bit) for a share of 1, and for two
// equal values.
inline float blended(float below, float wanted, float share) {
  return share < 1 ? below + (wanted - below) * share : wanted;
}

struct MaterialChange {
  std::optional<float> roughness{}, specular{}, metalness{};  // none: the value below stays
  std::optional<float> roughness_scale{};  // times the roughness below, cut off at 1; instead of `roughness`
  float blend = 1;                         // share of the new value; the rest is the value below

  bool empty() const { return !roughness && !specular && !metalness && !roughness_scale; }
  bool operator==(const MaterialChange&) const = default;
};

inline Material changed(const Material& below, const MaterialChange& c) {
  const float roughness = c.roughness         ? *c.roughness
                          : c.roughness_scale ? clamp(below.roughness * *c.roughness_scale, 0.0f, 1.0f)
                                              : below.roughness;
  return {blended(below.roughness, roughness, c.blend),
          blended(below.specular, c.specular.value_or(below.specular), c.blend),
          blended(below.metalness, c.metalness.value_or(below.metalness), c.blend)};
}

// Some of a material's values.
struct MaterialValues {
  bool roughness = false, specular = false, metalness = false;
};

// Whether the change affects a value that is not in `covered`.
inline bool shows(const MaterialChange& c, const MaterialValues& covered) {
  return ((c.roughness || c.roughness_scale) && !covered.roughness) || (c.specular && !covered.specular) ||
         (c.metalness && !covered.metalness);
}

// Adds the values that the change replaces completely.
inline void cover(MaterialValues& covered, const MaterialChange& c) {
  if (c.blend < 1) return;
  covered.roughness |= c.roughness.has_value();
  covered.specular |= c.specular.has_value();
  covered.metalness |= c.metalness.has_value();
}

// Another albedo, with or without the texture below it. All colors linear.
struct Tint {
  Vec3f color;
  bool keep_texture = true;  // scale the albedo below per channel so that its mean becomes `color`
  Vec3f mean{1, 1, 1};       // of the albedo below, over the region, when the edit was made
  float blend = 1;           // share of the new value; the rest is the value below
};

inline Vec3f tinted(const Tint& t, Vec3f below) {
  constexpr float kDark = 1e-3f;  // floor of the mean, for channels that are black
  Vec3f out;
  for (int c = 0; c < 3; ++c) {
    const float wanted =
        t.keep_texture ? min(below[c] * t.color[c] / max(t.mean[c], kDark), 1.0f) : t.color[c];
    out[c] = blended(below[c], wanted, t.blend);
  }
  return out;
}

}  // namespace cei3d
