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

// One lobe in place of both: their mean, weighted by their shares.
inline LobeFrame<float> mean_lobe(const SurfaceReflection<float>& r) {
  const auto mean = [&](auto base, auto fresnel) { return mean_of_lobes(r.share, base, fresnel); };
  return {normalize(mean(r.base.axis, r.fresnel.axis)), r.base.across,
          mean(r.base.roughness, r.fresnel.roughness), mean(r.base.stretch, r.fresnel.stretch),
          r.base.normal};
}

}  // namespace cei3d
