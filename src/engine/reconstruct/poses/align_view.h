// SPDX-License-Identifier: Apache-2.0
// Moves a camera until the picture of a model from there matches the photograph: direct image alignment
// [Lucas and Kanade 1981] with the depths of the model. Views of one camera may change their focal length
// together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"
#include "core/math/rigid_motion.h"
#include "engine/reconstruct/geometry/model_view.h"

namespace cei3d {

struct AlignOptions {
  int steps = 15;  // maximum number of steps for each of the blurs
  // Expected standard deviations of a turn, radians, and of a shift, unit frame. This prior decides only
  // about motions that the images do not determine.
  double turn = 0.02, shift = 0.02;
};

// How much motions, (turn, shift), move points in the image: the sum over points of the outer products of the
// derivatives of their pixel positions.
using MotionInformation = std::array<std::array<double, 6>, 6>;
MotionInformation information_of(const Camera&, std::span<const Vec3d> points);

struct Alignment {
  RigidMotion motion;               // of the camera, after dolly_zoomed() by the factor that was found
  double pixels = 0;                // root mean square distance by which the model's points move in the image
  MotionInformation information{};  // of the model's points
};

// What a view says about a change x of the logarithm of the focal length, with the pose eliminated (chosen
// optimally for each x): the logarithm of the likelihood changes by pull x - information x^2 / 2.
struct FocalPull {
  double information = 0, pull = 0;
};

// photograph: RGBA of the size of the camera; color over white, alpha 1 where it is known, else 0. Model and
// photograph must outlive it.
class ViewAligner {
 public:
  ViewAligner(const Camera& given, const ModelView& model, const Image& photograph, const AlignOptions&);
  void align_pose();  // to be called first
  FocalPull focal_pull();
  // Changes the logarithm of the focal length by `change`, and moves the camera to the pose that the last
  // focal_pull() found for it.
  void zoom(double change);
  Alignment alignment() const;

 private:
  struct Point {
    Vec3f at;
    uint16_t x, y;  // pixel of the model
  };
  template <int N>
  struct Equations;
  template <int N>
  Equations<N> equations(const Image& rendered, const Image& shown) const;
  template <int N>
  void add_point(const Point&, const Image& rendered, const Image& shown, Equations<N>&) const;
  template <int N>
  double add_prior(Equations<N>&) const;
  std::vector<Point> points_of_model() const;
  double mean_way(const Camera& from, const Camera& to) const;

  Camera given_, camera_;
  const ModelView& model_;
  const Image& photograph_;
  AlignOptions options_;
  std::vector<Point> points_;
  double log_focal_ = 0;  // logarithm of the factor on the focal length so far
  // The best motion, (turn, shift), is a linear function of the change x of the logarithm of the focal
  // length: still_ - x follow_.
  std::array<double, 6> still_{}, follow_{};
};

// Aligns the pose alone.
Alignment align_view(const Camera&, const ModelView&, const Image& photograph, const AlignOptions& = {});

}  // namespace cei3d
