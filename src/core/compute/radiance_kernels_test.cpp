// SPDX-License-Identifier: Apache-2.0
// Input of the radiance network: its gradient against finite differences, and what a turned light turns.
#include <gtest/gtest.h>

#include "core/compute/test_kernels.h"

namespace cei3d {
namespace {

void expect_radiance_gradient(RadianceData d) {
  const Device device = make_device("cpu/scalar");
  const std::vector<float>& weights = d.d_input;
  device.launch<RadianceInputGrad>(d.gradient(), kN);
  const auto loss = [&](int sample) {
    device.launch<RadianceInput>(d.forward(), kN);
    double sum = 0;
    for (int r = 0; r < radiance_rows(kFeatures); ++r) {
      const size_t at = panel_at(sample, 1, 0, radiance_rows(kFeatures), r);
      sum += double(weights[at]) * d.input[at];
    }
    return sum;
  };
  int checked = 0;
  for (int i = 0; i < kN; i += 5) {
    const Vec3f g = load_sdf_gradient<float>(d.jets.data(), i, 1 + kFeatures);
    if (length(g) < 0.4f) continue;  // the normal of a short gradient turns too fast for differences in float
    ++checked;
    const std::pair<int, int> columns[] = {{0, 1}, {0, 4}, {1, 0}, {2, 0}, {3, 0}};  // (jet column, row)
    for (const auto& [column, row] : columns) {
      float& v = d.jets[panel_at(i, 4, column, 1 + kFeatures, row)];
      const float keep = v, h = 2e-3f;
      v = keep + h;
      const double up = loss(i);
      v = keep - h;
      const double down = loss(i);
      v = keep;
      const double want = (up - down) / (2 * double(h));
      EXPECT_NEAR(d.d_jets[panel_at(i, 4, column, 1 + kFeatures, row)], want, 0.01 * (1 + std::abs(want)))
          << i << " " << column;
    }
  }
  EXPECT_GT(checked, 10);
}

TEST(Kernels, UnderATurnedLightTheNormalAloneIsTurned) {
  const Device device = make_device("cpu/scalar");
  RadianceData turned{.turned = true}, still;
  device.launch<RadianceInput>(turned.forward(), kN);
  device.launch<RadianceInput>(still.forward(), kN);
  const int rows = radiance_rows(kFeatures);
  const auto at = [&](const RadianceData& d, int i, int row) {
    return d.input[panel_at(i, 1, 0, rows, row)];
  };
  for (int i = 0; i < kN; ++i) {
    const Vec3f normal{at(still, i, kFeatures), at(still, i, kFeatures + 1), at(still, i, kFeatures + 2)};
    const Vec3f in_room = sample_rotation(i) * normal;
    for (int row = 0; row < rows; ++row) {
      const int k = row - kFeatures;
      EXPECT_NEAR(at(turned, i, row), k >= 0 && k < 3 ? in_room[k] : at(still, i, row), 1e-5f)
          << i << " " << row;
    }
  }
}

TEST(Kernels, RadianceInputGradientEqualsFiniteDifferences) {
  expect_radiance_gradient({});
  expect_radiance_gradient({.turned = true});
}

}  // namespace
}  // namespace cei3d
