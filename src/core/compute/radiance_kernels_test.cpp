// SPDX-License-Identifier: Apache-2.0
// Input of the radiance network: its gradient against finite differences.
#include <gtest/gtest.h>

#include "core/compute/test_kernels.h"

namespace cei3d {
namespace {

TEST(Kernels, RadianceInputGradientEqualsFiniteDifferences) {
  RadianceData d;
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

}  // namespace
}  // namespace cei3d
