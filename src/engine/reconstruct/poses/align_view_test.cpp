// SPDX-License-Identifier: Apache-2.0
// Pictures of a checkered box from two poses: alignment has to find the motion between them.
#include "engine/reconstruct/poses/align_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {
namespace {

constexpr int kSize = 96;

Vec3f checkers(Vec3f p) {
  const bool odd = (int(std::floor(p.x * 5)) + int(std::floor(p.y * 5)) + int(std::floor(p.z * 5))) & 1;
  return odd ? Vec3f{0.5f, 0.2f, 0.1f} : Vec3f{0.1f, 0.3f, 0.5f};
}

// RGBA over white, of alpha 1.
Image photograph(const Camera& camera) {
  Image image = filtered_box_picture(camera, checkers);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* p = image.at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = srgb_from_linear(p[c]) * p[3] + 1 - p[3];
      p[3] = 1;
    }
  return image;
}

ModelView model_from(const Camera& camera) {
  const Image rgba = photograph(camera);
  ModelView view{Image(kSize, kSize, 3), Image(kSize, kSize, 1)};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      for (int c = 0; c < 3; ++c) view.srgb.at(x, y)[c] = rgba.at(x, y)[c];
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      float depth = 0;
      while (depth < 4 && pit_box().distance(ray.origin + ray.direction * depth) > 1e-4f)
        depth += pit_box().distance(ray.origin + ray.direction * depth);
      *view.depth.at(x, y) = depth < 4 ? depth : 0;
    }
  return view;
}

Vec3d random_vector(Rng& rng, double size) {
  return Vec3d{rng.normal(), rng.normal(), rng.normal()} * (size / std::sqrt(3.0));
}

// How far two cameras see the corners of the box apart, in pixels at most.
double apart(const Camera& a, const Camera& b) {
  double largest = 0;
  for (const double x : {-0.4, 0.4})
    for (const double y : {-0.4, 0.4})
      for (const double z : {-0.35, 0.35}) {
        const Vec3d d = a.project({x, y, z}) - b.project({x, y, z});
        largest = std::max(largest, std::hypot(d.x, d.y));
      }
  return largest;
}

TEST(AlignView, FindsWhereTheCameraStood) {
  for (uint64_t i = 0; i < 6; ++i) {
    Rng rng(7, 0, i);
    const Camera truth = box_camera(-0.5 + 0.25 * double(i), 1.7 * double(i), kSize);
    const Camera wrong = moved(truth, {random_vector(rng, 0.01), random_vector(rng, 0.02)});
    const Alignment found = align_view(wrong, model_from(wrong), photograph(truth));
    EXPECT_GT(apart(wrong, truth), 1) << i;
    EXPECT_LT(apart(moved(wrong, found.motion), truth), 0.25) << i;
    EXPECT_NEAR(found.pixels, apart(wrong, truth), 0.6 * apart(wrong, truth)) << i;
  }
}

TEST(AlignView, LeavesACameraThatIsRight) {
  const Camera camera = box_camera(0.4, 0.6, kSize);
  EXPECT_LT(align_view(camera, model_from(camera), photograph(camera)).pixels, 0.01);
}

// Nothing is known about what the photograph shows: the expected motion is none.
TEST(AlignView, StaysWithoutEvidence) {
  const Camera camera = box_camera(0.4, 0.6, kSize);
  Image unknown = photograph(box_camera(0.4, 0.7, kSize));
  for (size_t i = 3; i < unknown.data.size(); i += 4) unknown.data[i] = 0;
  EXPECT_LT(align_view(camera, model_from(camera), unknown).pixels, 1e-9);
}

}  // namespace
}  // namespace cei3d
