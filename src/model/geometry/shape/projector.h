// SPDX-License-Identifier: Apache-2.0
// A mask projected from one camera onto the surface that this camera sees: the sharp outline of a painted
// region.
#pragma once

#include <string>

#include "core/base/json_reader.h"
#include "core/base/tensors.h"
#include "core/image/image.h"
#include "core/math/camera.h"

namespace cei3d {

struct Projector {
  Camera camera;           // unit frame; its image may be a crop of the painted view
  Image alpha;             // 1 channel, [0, 1], over the whole image
  float min_alpha = 0.5f;  // the mask is where alpha >= min_alpha
  Image depth;             // 1 channel, z-depth over the whole image, may be finer; 0: no surface
  // Maximum distance behind the stored depth of a point that counts as seen, unit frame.
  float tolerance = 0.012f;
  float min_facing = 0.1f;  // minimum cosine between the normal and the direction to the camera

  bool empty() const { return alpha.empty(); }
  bool soft() const { return min_alpha < 0.5f; }  // alpha is a weight, not only a mask
  // Alpha at the pixel position (u, v): bilinear between texel centers, 0 outside the image.
  float alpha_at(double u, double v) const;
  // Whether the camera sees the point, the point faces it and lies in the mask.
  bool covers(Vec3f position, Vec3f normal) const;

 private:
  bool sees(double u, double v, double z) const;
};

// Writes tensors under `prefix`, sizes and camera to the head. Errors of loading: missing tensors or keys,
// sizes that disagree.
void save_projector(const Projector&, Tensors& tensors, Json& head, const std::string& prefix);
Projector load_projector(const Tensors& tensors, JsonReader head, const std::string& prefix);

}  // namespace cei3d
