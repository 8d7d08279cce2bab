// SPDX-License-Identifier: Apache-2.0
// A mask seen from one camera, laid onto the surface that this camera sees: the sharp outline of a painted
// region.
#pragma once

#include <string>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "core/image/image.h"
#include "core/math/camera.h"

namespace cei3d {

struct Projector {
  Camera camera;             // unit-sphere frame; its picture may be a crop of the view that was painted
  Image alpha;               // 1 channel, [0, 1], over the whole picture
  float least_alpha = 0.5f;  // the mask is where alpha is not less
  Image depth;  // 1 channel, z-depth of the surface, over the whole picture, may be finer; 0: none
  // How far behind the stored depth a point still counts as seen, unit-sphere units
  float tolerance = 0.012f;
  float min_facing = 0.1f;  // least cosine between the normal and the way to the camera

  bool empty() const { return alpha.empty(); }
  bool soft() const { return least_alpha < 0.5f; }  // alpha says how much, not only where
  // Alpha at the pixel position (u, v): bilinear between texel centers, 0 outside the picture.
  float alpha_at(double u, double v) const;
  // Whether the point is seen by the camera, faces it and lies in the mask.
  bool covers(Vec3f position, Vec3f normal) const;

 private:
  bool sees(double u, double v, double z) const;
};

// Tensors under `prefix`, sizes and camera in the head; and back. Errors: missing tensors or keys, sizes that
// disagree.
void save_projector(const Projector&, Tensors& tensors, Json& head, const std::string& prefix);
Projector load_projector(const Tensors& tensors, const Json& head, const std::string& prefix);

}  // namespace cei3d
