// SPDX-License-Identifier: Apache-2.0
// The light of synthetic scenes: distant, a few spherical Gaussians, known in closed form and sampled
// exactly.
#pragma once

#include <string>
#include <vector>

#include "model/light/sg_mixture.h"

namespace cei3d {

std::vector<std::string> light_names();
SgMixture light_by_name(const std::string& name);  // usage error: unknown; the names are listed

// The light of a body on a turntable, in the body's frame, for a camera there: fixed lamps turn with the
// camera about +z, L_camera(w) = L(Rz(-azimuth) w) with the azimuth of the camera's position.
SgMixture turned_with(const SgMixture&, Vec3d camera_center);

// Draws directions in proportion to the light's luminance. lambda may be 0: a uniform light.
class LightSampler {
 public:
  explicit LightSampler(const SgMixture&);

  struct Value {
    Vec3f radiance;
    float density;  // of sample(), per steradian
  };
  Value at(Vec3f direction) const;
  Vec3f sample(float pick, Vec2<float> u) const;  // arguments uniform in [0, 1)

 private:
  struct Lobe {
    SgLobe sg;
    float share, norm;  // probability that the lobe is picked; density at its peak
  };
  std::vector<Lobe> lobes_;
};

}  // namespace cei3d
