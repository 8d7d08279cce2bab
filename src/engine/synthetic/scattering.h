// SPDX-License-Identifier: Apache-2.0
// Reflectance at a point of a synthetic surface, evaluated and sampled exactly: GGX microfacets and a diffuse
// base. It is what the program's shading approximates by tables and lobes.
#pragma once

#include "core/math/tangents.h"
#include "model/material/material.h"

namespace cei3d {

enum class Diffuse {
  burley,   // darker or brighter at flat angles, by roughness [Burley 2012]: what the program assumes
  lambert,  // the same towards all directions
};

class Scattering {
 public:
  // to_viewer: unit, above the surface.
  Scattering(Vec3f normal, Vec3f to_viewer, const Material&, Vec3f albedo, Diffuse);

  // Reflectance density, 1/sr, times the cosine of the light; zero below the horizon.
  Vec3f reflected(Vec3f to_light) const;
  float density(Vec3f to_light) const;  // of sample(), per steradian
  // A direction that light comes from; it may lie below the horizon. Arguments uniform in [0, 1).
  Vec3f sample(float pick, Vec2<float> u) const;

 private:
  Vec3f normal_, view_;
  Tangents<float> tangents_;
  float nv_, roughness_, alpha_;
  Vec3f f0_, diffuse_;  // diffuse_: times pi
  float f90_;
  float mirror_share_;  // probability that sample() takes a facet instead of the diffuse base
  Diffuse model_;
};

}  // namespace cei3d
