// SPDX-License-Identifier: Apache-2.0
#include "core/math/lens.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"

namespace cei3d {

template <class T>
Dual<T> atan(Dual<T> a) {
  return {atan(a.value), a.derivative / (T(1.0) + a.value * a.value)};
}

namespace {

const LensDistortion kLenses[] = {
    {LensKind::perspective, {0.08, 0, 0, 0}, {}, 0, 0},                              // simple radial
    {LensKind::perspective, {-0.21, 0.06, 0, 0}, {}, 0, 0},                          // radial
    {LensKind::perspective, {0.0578, -0.0805, 0, 0}, {}, -0.00098, 0.00016},         // OpenCV
    {LensKind::perspective, {-0.3, 0.11, -0.02, 0.004}, {}, 0.002, -0.001},          // Metashape, four terms
    {LensKind::perspective, {0.9, 0.4, 0.02, 0}, {1.1, 0.5, 0.05}, 0.0007, 0.0012},  // full OpenCV
    {LensKind::fisheye, {0.02, -0.006, 0.002, -0.0004}, {}, 0, 0},
    {LensKind::fisheye, {}, {}, 0, 0},
};

TEST(Lens, OfAnotherFocalLengthMovesPixelsAsBefore) {
  constexpr double kFactor = 1.03;
  for (const LensDistortion& lens : kLenses) {
    if (lens.kind == LensKind::fisheye) continue;
    const LensDistortion other = zoomed(lens, kFactor);
    for (const Vec2d p : {Vec2d{0, 0}, Vec2d{0.3, -0.2}, Vec2d{-0.5, 0.45}}) {
      const Vec2d before = distorted(lens, p), after = distorted(other, p * (1 / kFactor)) * kFactor;
      EXPECT_NEAR(before.x, after.x, 1e-12);
      EXPECT_NEAR(before.y, after.y, 1e-12);
    }
    EXPECT_EQ(zoomed(lens, 1), lens);
  }
}

TEST(Lens, DerivativeAgainstDualNumbers) {
  using D = Dual<double>;
  for (const LensDistortion& lens : kLenses)
    for (const Vec2d p : {Vec2d{0, 0}, Vec2d{0.3, -0.2}, Vec2d{-0.5, 0.45}, Vec2d{1e-5, 2e-6}}) {
      const Jacobian2<double> j = distortion_jacobian(lens, p);
      const auto x = distorted(lens, Vec2<D>{D(p.x, 1.0), D(p.y, 0.0)});
      const auto y = distorted(lens, Vec2<D>{D(p.x, 0.0), D(p.y, 1.0)});
      EXPECT_NEAR(j.x.x, x.x.derivative, 1e-9);
      EXPECT_NEAR(j.x.y, x.y.derivative, 1e-9);
      EXPECT_NEAR(j.y.x, y.x.derivative, 1e-9);
      EXPECT_NEAR(j.y.y, y.y.derivative, 1e-9);
    }
}

TEST(Lens, PixelsGoRoundTrip) {
  const Camera photo{4000, 3000, 2900, 2910, 2011.3, 1489.2, 0.4, Mat3d::identity(), {}};
  const Camera pinhole{1200, 900, 2900, 2900, 511.5, 402.5, 0, Mat3d::identity(), {}};
  for (const LensDistortion& lens : kLenses) {
    const PhotoCamera camera(photo, lens);
    int n = 0;
    for (double x = 0; x <= 4000; x += 250)
      for (double y = 0; y <= 3000; y += 250) {
        const auto there = pinhole_from_photo(camera, pinhole, {x, y});
        ASSERT_TRUE(there) << x << " " << y;
        const auto back = photo_from_pinhole(camera, pinhole, *there);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, x, 1e-6);
        EXPECT_NEAR(back->y, y, 1e-6);
        ++n;
      }
    EXPECT_EQ(n, 17 * 13);
  }
}

// A fisheye lens without terms images an angle as a radius.
TEST(Lens, EquidistantFisheyeImagesAngles) {
  LensDistortion lens;
  lens.kind = LensKind::fisheye;
  const Vec2d p = distorted(lens, Vec2d{std::tan(0.7), 0});
  EXPECT_NEAR(p.x, 0.7, 1e-12);
  EXPECT_TRUE(distorts(lens));
  EXPECT_FALSE(distorts(LensDistortion()));
}

// Beyond the radius where barrel distortion folds back, two directions would have one pixel.
TEST(Lens, EndsWhereItFoldsBack) {
  const LensDistortion lens{LensKind::perspective, {-0.3, 0, 0, 0}, {}, 0, 0};
  const double fold = std::sqrt(1 / 0.9);  // 1 - 3 * 0.3 r^2 = 0
  EXPECT_NEAR(lens_reach(lens), fold, 0.01);
  EXPECT_FALSE(undistorted(lens, fold, {0.9, 0}));
  EXPECT_TRUE(undistorted(lens, fold, {0.6, 0}));
  const PhotoCamera photo{{100, 100, 50, 50, 50, 50, 0, Mat3d::identity(), {}}, lens};
  EXPECT_FALSE(project(photo, {1.2, 0, 1}));
  EXPECT_FALSE(project(photo, {0, 0, -1}));
}

TEST(Lens, ProjectsWhatItsPixelsSee) {
  Camera c{640, 480, 500, 510, 322, 239, 0, upright_rotation({1, 0.2, 0.1}, {0, 0, 1}), {-3, 0.1, 0.4}};
  const PhotoCamera photo{c, kLenses[2]};
  const Vec3d point{0.2, 0.3, -0.1};
  const Vec3d ideal = c.project(point);
  const auto a = project(photo, point), b = photo_from_pinhole(photo, c, {ideal.x, ideal.y});
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->x, b->x, 1e-9);
  EXPECT_NEAR(a->y, b->y, 1e-9);
  EXPECT_GT(std::abs(a->x - ideal.x), 0.01);
}

}  // namespace
}  // namespace cei3d
