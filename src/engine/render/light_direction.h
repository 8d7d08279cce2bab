// SPDX-License-Identifier: Apache-2.0
// Where the light that reaches a surface comes from, by the normal of the surface. Burley's diffuse term
// depends on it: light that enters at a grazing angle counts for less on a smooth surface, and a rough one
// seen at a grazing angle is brighter on the side of the light. [Burley 2012, sec. 5.3]
#pragma once

#include "core/math/brdf.h"
#include "engine/render/direction_map.h"
#include "engine/render/transport.h"

namespace cei3d {

// Means over the light above a surface, weighted by its luminance and the cosine to the normal.
struct LightDirection {
  Vec3f mean;          // direction; shorter where light comes from all around: 2/3 of the normal if evenly
  Vec3f grazing_mean;  // direction times (1 - cosine)^5
  float grazing;       // (1 - cosine)^5

  DiffuseLight<float> towards(Vec3f viewer) const {
    return {dot(mean, viewer), grazing, dot(grazing_mean, viewer)};
  }
};
inline LightDirection operator+(const LightDirection& a, const LightDirection& b) {
  return {a.mean + b.mean, a.grazing_mean + b.grazing_mean, a.grazing + b.grazing};
}
inline LightDirection operator*(float s, const LightDirection& a) {
  return {a.mean * s, a.grazing_mean * s, a.grazing * s};
}

using LightDirectionMap = DirectionMapOf<LightDirection>;

LightDirectionMap light_directions(const SkyRadiance&);

}  // namespace cei3d
