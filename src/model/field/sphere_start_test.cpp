// SPDX-License-Identifier: Apache-2.0
// A field that begins as a sphere against the distance to that sphere.
#include "model/field/sphere_start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.5f;

// The paper's network: 8 layers of 512, softplus, 6 frequencies that the fourth reads again.
FieldConfig paper_network() {
  FieldConfig c;
  c.encoding.frequencies = 6;
  c.hidden_layers = 8;
  c.width = 512;
  c.skip_layer = 4;
  c.activation = Activation::softplus;
  c.outputs = 1;
  return c;
}

TEST(SphereStart, IsNearlyTheDistanceToTheSphere) {
  const Device device = make_device();
  Field field(paper_network(), 3);
  begin_as_sphere(device, field, kRadius, 3);
  std::vector<Vec3f> x;
  for (uint64_t i = 0; i < 400; ++i) {
    Rng rng(1, 0, i);
    x.push_back(normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * (0.1f + 0.85f * rng.uniform()));
  }
  const std::vector<float> values = first_output(device, field, x);
  double off = 0, slope = 0, outside = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double distance = double(length(x[i])) - kRadius;
    off += std::abs(double(values[i]) - distance) / double(x.size());
    if (std::abs(distance) > 0.1) {
      EXPECT_GT(double(values[i]) * distance, 0) << length(x[i]);
      slope += double(values[i]) / distance;
      ++outside;
    }
  }
  EXPECT_LT(off, 0.12);  // softplus rounds off the tip in the middle of the sphere
  EXPECT_NEAR(slope / outside, 0.8, 0.3);
}

TEST(SphereStart, LeavesAFieldThatIsOne) {
  const Device device = make_device();
  FieldConfig config;
  config.sphere_radius = 0.4f;
  Field field(config, 3);
  const Field before = field;
  begin_as_sphere(device, field, kRadius, 3);
  for (size_t t = 0; t < field.params().all().size(); ++t)
    EXPECT_EQ(field.params().all()[t].value, before.params().all()[t].value);
}

}  // namespace
}  // namespace cei3d
