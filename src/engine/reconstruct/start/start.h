// SPDX-License-Identifier: Apache-2.0
// Shapes that the geometry stage can start from.
#pragma once

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/start/carve.h"
#include "engine/reconstruct/start/stereo.h"

namespace cei3d {

enum class Start {
  hull,    // the visual hull of the masks
  carved,  // the hull without the cells that the colors show to be empty (engine/reconstruct/start/carve.h)
  stereo,  // the hull without the cells that depth maps see through (engine/reconstruct/start/stereo.h)
};

struct ShapeOptions {
  int cells = 128;         // per axis, of the shapes by masks and colors
  int stereo_cells = 192;  // per axis, of the shape by depths
  CarveOptions carving;
  StereoOptions stereo;
};

// Errors: empty hull; interrupted.
StartShape start_shape(const PixelStore&, Start, uint64_t seed, const ShapeOptions& options = {},
                       const Progress& progress = Progress());

// A short training that rates a start shape.
struct TrialOptions {
  ShapeOptions shapes;
  GeometryOptions geometry;
  int steps = 400;
  int rays = 32768;          // number of random training pixels of the comparison
  bool hull_alone = false;   // whether no other start is tried; cameras and exposures are found with it
  LightFrame light;          // in the training views
  bool align = false;        // whether cameras are moved where that pays
  double align_seconds = 0;  // after so many no further alignment begins; 0: no limit
  // With `align`: standard deviation of the logarithm of the focal length as it is given; 0: it is right,
  // or its error is not known. That of EXIF notes is wrong by some percent, that of a calibration by less.
  double focal_error = 0;
  std::vector<Vec3f> exposures;  // of the views, by their cameras' notes; empty: not known
  Clock clock = steady_seconds;
};

// Trains briefly from each start shape and returns the one with the highest PSNR. Carving opens concavities
// of the visual hull (the inside of a shovel) but fails on mirror images (it hollows out a metal body where
// the reflections seem to be) and is left out under a light that turns; stereo finds hollows in textured
// surface only. With `align` the cameras of the store, poses and focal length, are aligned with what was
// trained from the hull, as long as it explains the pixels better for it; the noted exposures become the
// store's if the photographs show them. Error: interrupted.
StartShape choose_start(const Device&, PixelStore&, const TrialOptions&, uint64_t seed, Progress&);

}  // namespace cei3d
