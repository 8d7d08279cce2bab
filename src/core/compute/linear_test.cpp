// SPDX-License-Identifier: Apache-2.0
// Linear layers against plain loops in double, and on every device against the scalar one.
#include "core/compute/linear.h"

#include <gtest/gtest.h>

#include "core/compute/test_kernels.h"

namespace cei3d {
namespace {

std::vector<float> linear_case(const Device& device, int in, int out) {
  const auto x = noise(size_t(kN) * in, 15), w = noise(size_t(in) * out, 16), b = noise(out, 17);
  std::vector<float> y(size_t(kN) * out);
  device.linear({kN / kPanel, in, out, x.data(), in, w.data(), in, b.data(), y.data(), out});
  return y;
}

TEST(Linear, EveryDeviceAgreesWithTheScalarOne) {
  expect_parity({"7 to 13", [](const Device& d) { return linear_case(d, 7, 13); }});
  expect_parity({"64 to 64", [](const Device& d) { return linear_case(d, 64, 64); }});
}

void expect_plain_loops(int in, int out, int panels, double sum_tolerance = 1e-4) {
  for (const Device& device : all_devices()) {
    const int x_stride = in + 2, y_stride = out + 1;
    const auto x = noise(size_t(panels) * x_stride * kPanel, 1), w = noise(in * out, 2), b = noise(out, 3);
    std::vector<float> y(size_t(panels) * y_stride * kPanel, -5.0f);
    device.linear({panels, in, out, x.data(), x_stride, w.data(), in, b.data(), y.data(), y_stride});
    const auto d_y = noise(y.size(), 4);
    std::vector<float> d_w(in * out, 0.5f), d_b(out, 0.25f);
    device.linear_weight_grad(
        {panels, in, out, x.data(), x_stride, d_y.data(), y_stride, d_w.data(), in, d_b.data()});
    std::vector<double> want_w(in * out, 0.5), want_b(out, 0.25);
    for (int p = 0; p < panels; ++p)
      for (int s = 0; s < kPanel; ++s) {
        for (int o = 0; o < out; ++o) {
          const double d = d_y[(size_t(p) * y_stride + o) * kPanel + s];
          double sum = b[o];
          for (int i = 0; i < in; ++i) {
            const double v = x[(size_t(p) * x_stride + i) * kPanel + s];
            sum += w[o * in + i] * v;
            want_w[o * in + i] += d * v;
          }
          want_b[o] += d;
          EXPECT_NEAR(y[(size_t(p) * y_stride + o) * kPanel + s], sum, 1e-5);
        }
        EXPECT_EQ(y[(size_t(p) * y_stride + out) * kPanel + s], -5.0f);  // rows beyond are left alone
      }
    for (int k = 0; k < in * out; ++k) EXPECT_NEAR(d_w[k], want_w[k], sum_tolerance) << device.name();
    for (int o = 0; o < out; ++o) EXPECT_NEAR(d_b[o], want_b[o], sum_tolerance);
  }
}

TEST(Linear, EqualsPlainLoops) {
  expect_plain_loops(9, 6, 8);
  expect_plain_loops(41, 13, 24);  // more than a block of weight gradients, either way; tiles of every height
  // On a card: more panels than blocks, and more outputs and inputs than a tile; sums of 70,000 numbers.
  expect_plain_loops(3, 2, 2201, 2e-3);
  expect_plain_loops(70, 71, 5);
}

TEST(Linear, FlushesDenormalsOnlyForThemselves) {
  volatile float small = 2e-38f, third = 0.3f;  // their product is denormal
  for (const Device& device : all_devices()) {
    const std::vector<float> x(kPanel, float(small)), weight{third};
    std::vector<float> y(kPanel, 1.0f);
    device.linear({1, 1, 1, x.data(), 1, weight.data(), 1, nullptr, y.data(), 1});
    EXPECT_EQ(y[0], 0) << device.name();
    EXPECT_GT(small * third, 0) << device.name();
  }
}

}  // namespace
}  // namespace cei3d
