// SPDX-License-Identifier: Apache-2.0
// Moves a camera until what a model shows from it lies where the photograph shows it: direct image alignment
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
  RigidMotion motion;               // of the camera, after dolly_zoomed() by the factor that was found
  double pixels = 0;                // root mean square of how far the model's points move in the image
  MotionInformation information{};  // of the model's points
};

// What a view says about a change x of the logarithm of the focal length, if its pose follows as it likes
// best: the logarithm of the likelihood changes by pull x - information x^2 / 2.
struct FocalPull {
  double information = 0, pull = 0;
};

// photograph: RGBA of the size of the camera; color over white, alpha 1 where it is known, else 0. Model and
// photograph must outlive it.
class ViewAligner {
 public:
  ViewAligner(const Camera& given, const ModelView& model, const Image& photograph, const AlignOptions&);
  void align_pose();  // to begin with
  FocalPull focal_pull();
  // Changes the logarithm of the focal length by this, and moves the camera as the last focal_pull() had it.
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
  double log_focal_ = 0;  // of the factor so far
  // The best motion, (turn, shift), for a change x of the focal length is still - x follow.
  std::array<double, 6> still_{}, follow_{};
};

// The pose alone.
Alignment align_view(const Camera&, const ModelView&, const Image& photograph, const AlignOptions& = {});

}  // namespace cei3d
