// SPDX-License-Identifier: Apache-2.0
// A scribble projected onto the surface: the points that it paints, and their colors.
#pragma once

#include <vector>

#include "core/image/image.h"
#include "core/math/pixel_box.h"
#include "engine/edit/routing.h"
#include "engine/render/render.h"
#include "model/geometry/shape/region.h"

namespace cei3d {

// Alpha from which a pixel of the scribble counts as painted: one half where partial alpha occurs only at
// smooth edges of opaque strokes; else, with semi-transparent strokes, half an 8-bit step.
float min_alpha(const Image& rgba);
// Bounding box of the painted pixels plus `margin` pixels, within the image. Width 0: nothing is painted.
PixelBox painted_box(const Image& rgba, int margin);

// Rays through the painted part of a view, several per pixel where the painted area is small.
struct Stroke {
  Camera camera;           // crop_camera(), unit frame
  int scale = 1;           // its pixels per pixel of the scribble
  float min_alpha = 0.5f;  // alpha from which a pixel is painted; below one half: alpha is a weight
  Image colors, alpha;     // the scribble's crop: linear RGB; 1 channel
  int painted_pixels = 0;
  int missed_pixels = 0;        // painted pixels without surface, or whose surface faces away (cosine <= 0.1)
  std::vector<Hit> hits;        // in and just around the paint, facing the camera
  std::vector<Vec3f> targets;   // #hits, linear albedo of the nearest painted pixel
  std::vector<float> opacity;   // #hits, alpha of that pixel
  std::vector<float> coverage;  // #hits, interpolated alpha; >= min_alpha: painted
  // #hits, distance between neighboring rays on the surface, unit frame
  std::vector<float> footprints;
  std::vector<Hit> beside;  // less than a pixel beside the paint
  std::vector<float> beside_footprints;
  Image depth;  // of the crop at its finer scale, 0: nothing hit
};

// The scribble, transparent where the view shows its color already as albedo, to 1/255: paint that changes
// nothing leaves the surface as it is, finer than its pixels. unchanged: written, their number.
Image without_unchanged(const Device&, const Scene&, const Camera& camera, const Image& rgba, int& unchanged);

// camera: unit frame; rgba: sRGB, straight alpha, of the camera's size.
Stroke trace_stroke(const Device&, const Scene&, const Camera& camera, const Image& rgba);

// Refines the handler points H where the stroke's rays are finer than them, and labels the refined ones: H+
// in the paint, the others beside it. All those of H that the stroke's view shows in its crop are among them.
// known: H on the present shape; null: there are none. added: written, the number of points that are not in
// H.
Region::Points refine_and_label(const Stroke&, const HandlerPoints* known, size_t& added);

// The region that the stroke paints. points: refine_and_label(). theta: for Routing::points, if above 0, a
// point belongs to the edit if one of H+ is nearer than this, as in the paper, unit frame. Routing::none has
// no region; it gets that of Routing::both.
Region stroke_region(const Stroke&, Region::Points points, Routing routing = Routing::both, float theta = 0);

}  // namespace cei3d
