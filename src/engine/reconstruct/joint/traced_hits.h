// SPDX-License-Identifier: Apache-2.0
// Hits of a batch of rays on the zero set of a field, and the way back: from the derivatives of a loss by
// depths and normals of the hits to those by values of the field. [paper eq. 6-11; core/math/field_hit.h]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/math/camera.h"
#include "model/field/field.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

// Derivatives of a loss by values of the field.
struct ValueGrads {
  std::vector<Vec3f> points;
  std::vector<float> d_values;  // #points
};

class TracedHits {
 public:
  // near: one for each ray, which goes from its camera through its position. are_near: whether these are hits
  // on a mesh close to the surface; else the surface is searched along the whole ray. The traced hits have
  // their triangles. sdf: not referred to afterwards.
  TracedHits(const Device&, const Field& sdf, std::span<const Hit> near, bool are_near = true);

  std::span<const Hit> hits() const { return hits_; }          // of the rays that meet the surface
  const std::vector<uint32_t>& rays() const { return rays_; }  // #hits, index of the ray
  const std::vector<Ray>& missed() const { return missed_; }   // the other rays
  std::vector<Vec3f> moved(float along) const;                 // positions, `along` further on their rays

  // d_depths, d_normals: #hits, dL/d(depth) and dL/d(normal). Appends to out.
  void backward(const Device&, std::span<const float> d_depths, std::span<const Vec3f> d_normals,
                ValueGrads& out) const;

 private:
  struct Planes;
  Planes planes(const std::vector<float>& values) const;
  void refine(const Device&, const std::vector<float>& values);

  FieldConfig config_;
  std::vector<Hit> hits_;
  std::vector<uint32_t> rays_;
  std::vector<Ray> missed_;
  std::vector<float> edges_;  // #hits, of sdf_gradients()
  std::vector<Vec3f> gradients_, gradients_along_;
};

}  // namespace cei3d
