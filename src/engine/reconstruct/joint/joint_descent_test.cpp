// SPDX-License-Identifier: Apache-2.0
// A ball whose pictures the shading model has drawn itself: from truths that are moved by a known amount, the
// joint descent alone has to come back.
#include "engine/reconstruct/joint/joint_descent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/rotation.h"
#include "engine/reconstruct/joint/joint_stage.h"
#include "engine/reconstruct/joint/test_ball.h"
#include "model/field/test_learned_field.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {
namespace {

constexpr float kOffset = 0.007f;  // 1 % of the radius
const Material kVarnish{0.2f, 0.5f, 0};

// How far the surface of the patch sticks out in direction d.
float patch(Vec3f d) {
  const float t = (dot(normalize(d), normalize(Vec3f{1, -0.5f, 0.6f})) - 0.9f) / 0.05f;
  const float s = clamp(t, 0.0f, 1.0f);
  return kOffset * s * s * (3 - 2 * s);
}

Field ball_field(const Device& device, bool with_patch) {
  return learned_distances(device, kSphereRadius, 0.02f,
                           [&](Vec3f x) { return length(x) - kSphereRadius - (with_patch ? patch(x) : 0); });
}

class JointRecovery : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    device_ = new Device(make_device());
    truth_ = new JointObject{ball_field(*device_, false), blobs(), kVarnish, studio()};
    pixels_ = new PixelStore(pictures_of(*device_, *truth_, surface_of(truth_->sdf), {16, 64}));
  }
  static void TearDownTestSuite() {
    delete pixels_;
    delete truth_;
    delete device_;
  }
  static std::shared_ptr<const Surface> surface_of(const Field& sdf) {
    return std::make_shared<const Surface>(extract_mesh(*device_, sdf, {64}));
  }
  static JointObject descended(const JointObject& start, const JointOptions& options, int steps) {
    const SurfaceAndHits seen =
        extract_surface_and_hits(*device_, start.sdf, {64}, *pixels_, 1000000, Progress());
    const AppearanceInput input{seen.surface, point_samples(seen.hits)};
    JointStageOptions stage{options, steps};
    Progress quiet;
    return descend_jointly(*device_, input, *pixels_, start, stage, quiet);
  }
  static JointOptions options() {
    JointOptions o;
    o.rays = 2048;
    o.box_points = o.near_points = o.mask_rays = 512;
    return o;
  }

  static inline const Device* device_;
  static inline const JointObject* truth_;
  static inline const PixelStore* pixels_;
};

// Mean distance of the patch's surface from the sphere, by rays from outside.
double patch_error(const Device& device, const Field& sdf) {
  std::vector<Vec3f> x;
  for (uint64_t i = 0; i < 4000; ++i) {
    Rng rng(5, 0, i);
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    if (patch(d) > 0.9f * kOffset) x.push_back(d * kSphereRadius);
  }
  const std::vector<float> values = first_output(device, sdf, x);
  double sum = 0;
  for (const float v : values) sum += std::abs(v) / double(values.size());
  return sum;
}

TEST_F(JointRecovery, APatchThatSticksOutGoesBack) {
  JointObject start = *truth_;
  start.sdf = ball_field(*device_, true);
  const double before = patch_error(*device_, start.sdf), reference = patch_error(*device_, truth_->sdf);
  ASSERT_NEAR(before, kOffset, 0.15 * kOffset);
  JointOptions o = options();
  o.rates.sdf_tables = 1e-3f;
  o.rates.sdf_layers = 0;
  const double after = patch_error(*device_, descended(start, o, 150).sdf);
  EXPECT_LT(after, 0.1 * before + reference);
}

TEST_F(JointRecovery, RoughnessComesBack) {
  JointObject start = *truth_;
  start.material = Material{0.4f, 0.5f, 0};
  JointOptions o = options();
  o.rates.material = 5e-2f;
  const JointObject after = descended(start, o, 400);
  EXPECT_NEAR(after.material.mean().roughness, 0.2f, 0.02f);
}

TEST_F(JointRecovery, ATurnedLightTurnsBack) {
  JointObject start = *truth_;
  const float angle = 5 * kPi / 180;
  start.light = rotated(truth_->light, about_axis(normalize(Vec3f{0.2f, 0.3f, 1}), angle));
  JointOptions o = options();
  o.rates.light = 1;
  const JointObject after = descended(start, o, 220);
  const auto error = [&](const SgMixture& light) {  // mean angle of the sharp lobes, radians
    double sum = 0;
    for (size_t k = 0; k < 3; ++k)
      sum += std::acos(std::min(1.0f, dot(light.lobes[k].axis, truth_->light.lobes[k].axis))) / 3;
    return sum;
  };
  EXPECT_LT(error(after.light), 0.1 * error(start.light));
}

}  // namespace
}  // namespace cei3d
