// SPDX-License-Identifier: Apache-2.0
// Moves a camera until what a model shows from it lies where the photograph shows it: direct image alignment
// [Lucas and Kanade 1981] with the depths of the model.
#pragma once

#include <array>
#include <span>

#include "core/math/camera.h"
#include "core/math/rigid_motion.h"
#include "engine/reconstruct/geometry/model_view.h"

namespace cei3d {

struct AlignOptions {
  int steps = 15;  // at most, at each of the blurs
  // Standard deviations of a turn (radians) and of a shift (world units) as they are expected; what the
  // images say weighs more, unless they say nothing.
  double turn = 0.02, shift = 0.02;
};

// How much motions, (turn, shift), move points in the image: the sum over points of the outer products of the
// slopes of their pixel positions.
using MotionInformation = std::array<std::array<double, 6>, 6>;
MotionInformation information_of(const Camera&, std::span<const Vec3d> points);

struct Alignment {
  RigidMotion motion;               // of the camera
  double pixels = 0;                // root mean square of how far the model's points move in the image
  MotionInformation information{};  // of the model's points
};

// photograph: RGBA of the size of the camera; color over white, alpha 1 where it is known, else 0.
Alignment align_view(const Camera&, const ModelView&, const Image& photograph, const AlignOptions& = {});

}  // namespace cei3d
