// SPDX-License-Identifier: Apache-2.0
// A scribble laid on the surface: which points it paints, and in which colors.
#pragma once

#include <vector>

#include "core/image/image.h"
#include "engine/edit/routing.h"
#include "engine/render/render.h"
#include "model/geometry/shape/region.h"

namespace cei3d {

// A rectangle of pixels.
struct PixelBox {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};
// The alpha from which a pixel of the scribble is painted: one half where alpha between nothing and all is
// that of smooth edges, beside opaque pixels; else, with semi-transparent strokes, the least that 8 bits can
// say.
float least_alpha(const Image& rgba);
// The painted pixels with `margin` pixels around, within the picture. Width 0: nothing is painted.
PixelBox painted_box(const Image& rgba, int margin);
// What the camera sees in the box, at `scale` pixels a pixel.
Camera crop_camera(const Camera& camera, const PixelBox& box, int scale);

// Rays through the painted part of a view, finer than its pixels where that is affordable.
struct Stroke {
  Camera camera;             // crop_camera, unit-sphere frame
  int scale = 1;             // its pixels a pixel of the scribble
  float least_alpha = 0.5f;  // from which a pixel is painted; less than one half: alpha says how much
  Image colors, alpha;       // the scribble's crop: linear RGB; 1 channel
  int painted_pixels = 0;
  int missed_pixels = 0;        // of them: those that meet no surface, or one that turns away (cosine <= 0.1)
  std::vector<Hit> hits;        // in and just around the paint, facing the camera
  std::vector<Vec3f> targets;   // #hits, linear base color: that of the painted pixel nearest to the hit
  std::vector<float> coverage;  // #hits, interpolated alpha; >= least_alpha: painted
  // #hits, distance between neighboring rays on the surface, unit-sphere units
  std::vector<float> footprints;
  Image depth;  // of the crop at its finer scale, 0: nothing hit
};

// camera: unit-sphere frame; rgba: sRGB, straight alpha, of the camera's size.
Stroke trace_stroke(const Device&, const Scene&, const Camera& camera, const Image& rgba);

// The part of the surface that the stroke paints. Routing::none has no region; it gets that of `both`.
Region stroke_region(const Stroke&, Routing routing = Routing::both);

}  // namespace cei3d
