// SPDX-License-Identifier: Apache-2.0
// Distortion of lenses. A direction (x, y, 1) in camera axes has the ideal image coordinates (x, y); a lens
// moves them, and the camera's K makes pixels of the moved ones. docs/method.md#lenses
#pragma once

#include <array>
#include <optional>

#include "core/math/camera.h"
#include "core/math/vec2.h"

namespace cei3d {

enum class LensKind {
  perspective,  // radial, rational and tangential terms [Brown 1971]
  fisheye       // equidistant: a polynomial of the angle to the axis [Kannala and Brandt 2006]
};

struct LensDistortion {
  LensKind kind = LensKind::perspective;
  std::array<double, 4> radial{};   // k1 ... k4: of r^2 ... r^8, fisheye of the angle likewise
  std::array<double, 3> divisor{};  // of r^2, r^4, r^6; perspective only
  double p1 = 0, p2 = 0;            // tangential, OpenCV's order; perspective only

  bool operator==(const LensDistortion&) const = default;
};

inline bool distorts(const LensDistortion& lens) { return lens != LensDistortion(); }

inline double atan(double a) { return ::atan(a); }

// Factor on both coordinates, and its derivative with respect to r^2.
template <class T>
struct RadialFactor {
  T value, d_r2;
};

template <class T>
T horner(const std::array<double, 4>& k, T t) {
  return T(1.0) + t * (T(k[0]) + t * (T(k[1]) + t * (T(k[2]) + t * T(k[3]))));
}
// Derivative of horner() with respect to t.
template <class T>
T horner_derivative(const std::array<double, 4>& k, T t) {
  return T(k[0]) + t * (T(2 * k[1]) + t * (T(3 * k[2]) + t * T(4 * k[3])));
}

template <class T>
RadialFactor<T> radial_factor(const LensDistortion& lens, T r2) {
  if (lens.kind == LensKind::fisheye) {
    const T safe = max(r2, T(1e-20)), r = sqrt(safe), angle = atan(r), t = angle * angle;
    const T value = angle * horner(lens.radial, t) / r;
    // Derivative of the moved angle with respect to r.
    const T d_r = (horner(lens.radial, t) + T(2.0) * t * horner_derivative(lens.radial, t)) / (T(1.0) + safe);
    return {value, (d_r - value) / (safe + safe)};
  }
  const std::array<double, 4> d{lens.divisor[0], lens.divisor[1], lens.divisor[2], 0};
  const T over = horner(lens.radial, r2), under = horner(d, r2), value = over / under;
  return {value, (horner_derivative(lens.radial, r2) - value * horner_derivative(d, r2)) / under};
}

template <class T>
Vec2<T> distorted(const LensDistortion& lens, Vec2<T> p) {
  const T r2 = p.x * p.x + p.y * p.y, f = radial_factor(lens, r2).value;
  const T p1(lens.p1), p2(lens.p2), two(2.0);
  return {p.x * f + two * p1 * p.x * p.y + p2 * (r2 + two * p.x * p.x),
          p.y * f + two * p2 * p.x * p.y + p1 * (r2 + two * p.y * p.y)};
}

// Derivatives of distorted(): column x holds those with respect to p.x.
template <class T>
struct Jacobian2 {
  Vec2<T> x, y;
};
template <class T>
Jacobian2<T> distortion_jacobian(const LensDistortion& lens, Vec2<T> p) {
  const T two(2.0), p1(lens.p1), p2(lens.p2);
  const RadialFactor<T> f = radial_factor(lens, p.x * p.x + p.y * p.y);
  const T mixed = two * (p.x * p.y * f.d_r2 + p1 * p.x + p2 * p.y);
  return {{f.value + two * (p.x * p.x * f.d_r2 + p1 * p.y) + T(6.0) * p2 * p.x, mixed},
          {mixed, f.value + two * (p.y * p.y * f.d_r2 + p2 * p.x) + T(6.0) * p1 * p.y}};
}

// The radius |p| up to which distorted() is one to one along the radius; at most kWidestRadius.
inline constexpr double kWidestRadius = 3.0;  // 72 degrees to the axis
double lens_reach(const LensDistortion&);

// Inverse of distorted() within the reach of the lens; none where no direction there has this image.
std::optional<Vec2d> undistorted(const LensDistortion&, double reach, Vec2d p);

// The lens with which a camera of `factor` times the focal length moves pixels as the camera with this lens
// does. Of perspective lenses; fisheye ones have none.
inline LensDistortion zoomed(LensDistortion lens, double factor) {
  double power = 1;
  for (size_t i = 0; i < lens.radial.size(); ++i) {
    power *= factor * factor;
    lens.radial[i] *= power;
    if (i < lens.divisor.size()) lens.divisor[i] *= power;
  }
  lens.p1 *= factor;
  lens.p2 *= factor;
  return lens;
}

// The camera that took a photograph: pose, K and size of the photograph, and its lens.
class PhotoCamera {
 public:
  PhotoCamera(const Camera& c, const LensDistortion& l) : camera_(c), lens_(l), reach_(lens_reach(l)) {}
  const Camera& camera() const { return camera_; }
  const LensDistortion& lens() const { return lens_; }
  double reach() const { return reach_; }

 private:
  Camera camera_;
  LensDistortion lens_;
  double reach_;
};

// Pixel positions of the same direction in the photograph and in a pinhole camera of the same pose. None:
// beyond the reach of the lens.
std::optional<Vec2d> photo_from_pinhole(const PhotoCamera&, const Camera& pinhole, Vec2d pixel);
std::optional<Vec2d> pinhole_from_photo(const PhotoCamera&, const Camera& pinhole, Vec2d pixel);

// Where the photograph shows a point in the frame of the pose; none: behind the camera or beyond the reach of
// the lens.
std::optional<Vec2d> project(const PhotoCamera&, Vec3d point);

}  // namespace cei3d
