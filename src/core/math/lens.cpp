// SPDX-License-Identifier: Apache-2.0
#include "core/math/lens.h"

#include <cmath>

namespace cei3d {
namespace {

double norm(Vec2d p) { return std::hypot(p.x, p.y); }

Vec2d ideal_from_pixel(const Camera& c, Vec2d pixel) {
  const double y = (pixel.y - c.cy) / c.fy;
  return {(pixel.x - c.cx - c.skew * y) / c.fx, y};
}
Vec2d pixel_from_ideal(const Camera& c, Vec2d p) {
  return {c.fx * p.x + c.skew * p.y + c.cx, c.fy * p.y + c.cy};
}

// Newton's step from p towards the point whose image differs by `error`.
Vec2d newton_step(const LensDistortion& lens, Vec2d p, Vec2d error) {
  const Jacobian2<double> j = distortion_jacobian(lens, p);
  const double det = signed_area(j.x, j.y);
  return {signed_area(error, j.y) / det, signed_area(j.x, error) / det};
}

// Where a radial lens without tangential terms would have put it, by bisection: a start from which Newton's
// steps converge.
Vec2d along_radius(const LensDistortion& lens, Vec2d p, double reach) {
  const double wanted = norm(p);
  double lo = 0, hi = reach;
  for (int i = 0; i < 30; ++i) {
    const double r = (lo + hi) / 2;
    (r * radial_factor(lens, r * r).value < wanted ? lo : hi) = r;
  }
  return wanted > 0 ? p * (lo / wanted) : p;
}

}  // namespace

double lens_reach(const LensDistortion& lens) {
  constexpr int kSteps = 600;
  double last = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = kWidestRadius * i / kSteps, moved = r * radial_factor(lens, r * r).value;
    if (!(moved > last)) return kWidestRadius * (i - 1) / kSteps;
    last = moved;
  }
  return kWidestRadius;
}

std::optional<Vec2d> undistorted(const LensDistortion& lens, double reach, Vec2d target) {
  Vec2d p = along_radius(lens, target, reach);
  for (int i = 0; i < 20; ++i) {
    const Vec2d step = newton_step(lens, p, target - distorted(lens, p));
    if (!std::isfinite(norm(step))) return std::nullopt;
    p = p + step;
    if (norm(step) < 1e-14) break;
  }
  if (!(norm(target - distorted(lens, p)) < 1e-10) || norm(p) > reach) return std::nullopt;
  return p;
}

std::optional<Vec2d> photo_from_pinhole(const PhotoCamera& photo, const Camera& pinhole, Vec2d pixel) {
  const Vec2d p = ideal_from_pixel(pinhole, pixel);
  if (norm(p) > photo.reach()) return std::nullopt;
  return pixel_from_ideal(photo.camera(), distorted(photo.lens(), p));
}

std::optional<Vec2d> pinhole_from_photo(const PhotoCamera& photo, const Camera& pinhole, Vec2d pixel) {
  const std::optional<Vec2d> p =
      undistorted(photo.lens(), photo.reach(), ideal_from_pixel(photo.camera(), pixel));
  if (!p) return std::nullopt;
  return pixel_from_ideal(pinhole, *p);
}

std::optional<Vec2d> project(const PhotoCamera& photo, Vec3d point) {
  const Vec3d c = transpose(photo.camera().world_from_cam) * (point - photo.camera().center);
  const Vec2d p{c.x / c.z, c.y / c.z};
  if (!(c.z > 0) || norm(p) > photo.reach()) return std::nullopt;
  return pixel_from_ideal(photo.camera(), distorted(photo.lens(), p));
}

}  // namespace cei3d
