// SPDX-License-Identifier: Apache-2.0
// The pattern of a scribble, continued over the part that it selects.
#pragma once

#include "core/base/progress.h"
#include "core/math/camera.h"
#include "engine/edit/part_scribble.h"
#include "model/scene/scene.h"

namespace cei3d {

// The pattern's albedo at a point of the surface: the tile stands where the view shows it and repeats in
// mirror images. Surface that is turned towards the view by less than 45 degrees gets it as the view projects
// it; other sides along the image's axes, at the same scale.
class PartPattern {
 public:
  // camera: of the scribble's view, unit frame. scribble must outlive this. depth: z-depth of the stroke.
  PartPattern(const PartScribble& scribble, const Camera& camera, double depth);
  Vec3f at(Vec3f position, Vec3f normal) const;  // linear
  float pixel() const { return float(pixel_); }  // size of a pixel of the tile on the surface, unit frame

 private:
  const PartScribble& scribble_;
  Camera camera_;
  double depth_, pixel_;  // of the stroke: z-depth; size of a pixel there, unit frame
};

// A branch that shows the pattern on the part of the layer. Errors: cancelled, no surface in the part.
std::shared_ptr<const Field> fit_pattern(const Device&, const Scene&, const EditLayer& part,
                                         const PartPattern&, Progress&);

}  // namespace cei3d
