// SPDX-License-Identifier: Apache-2.0
// The reflection lobes of a hit.
#pragma once

#include "core/math/reflection_axis.h"
#include "model/geometry/shape/hit.h"
#include "model/material/material.h"

namespace cei3d {

inline SurfaceReflection<float> reflection_of(const Hit& h, const Material& m) {
  return surface_reflection(reflection_tables(), h.normal, h.to_camera, m.roughness, m.specular, m.metalness);
}

// Mean of the axes of both lobes, weighted by their shares; unit.
inline Vec3f mean_axis(const SurfaceReflection<float>& r) {
  return normalize(r.base.axis * r.share + r.fresnel.axis * (1 - r.share));
}

}  // namespace cei3d
