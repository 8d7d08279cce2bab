// SPDX-License-Identifier: Apache-2.0
// Every kernel on every device of this machine against the scalar one; linear layers against plain loops in
// double.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <typeinfo>

#include "core/base/error.h"
#include "core/compute/device.h"
#include "core/compute/kernels/all.h"
#include "core/math/rng.h"
#include "core/math/rotation.h"

namespace cei3d {
namespace {

std::vector<float> noise(size_t n, uint64_t seed, float scale = 1) {
  std::vector<float> v(n);
  for (size_t i = 0; i < n; ++i) v[i] = scale * (2 * Rng(seed, 0, i).uniform() - 1);
  return v;
}

constexpr int kN = 96;  // samples: three panels

// Runs one kernel and returns all that it wrote.
struct Case {
  std::string name;
  std::function<std::vector<float>(const Device&)> run;
};

template <class A>
std::vector<float> activation_case(const Device& device, bool gradient) {
  const auto z = noise(kN * 5, 1, 2);
  auto y = noise(kN * 5, 2);
  const ActivateArgs a{z.data(), y.data(), 5, 5, 5, 10};
  gradient ? device.launch<ActivateGrad<A>>(a, kN) : device.launch<Activate<A>>(a, kN);
  return y;
}

template <class A>
std::vector<float> activate_twice_case(const Device& device) {
  std::vector<float> all = noise(kN * 5, 1, 2);
  all.resize(3 * kN * 5);
  device.launch<ActivateTwice<A>>({all.data(), all.data() + kN * 5, all.data() + 2 * kN * 5, 5, 5, 10}, kN);
  return all;
}

// Between the layers of a network whose gradient is taken: 5 rows, of the larger arrays 7.
struct GradientCase {
  std::vector<float> wide = noise(kN * 7, 30), slope = noise(kN * 5, 31), curvature = noise(kN * 5, 32),
                     d_wide = noise(kN * 7, 33), narrow = noise(kN * 5, 34), x = noise(kN * 4 * 7, 35),
                     d_y = noise(kN * 4 * 3, 36), y = std::vector<float>(kN * 4 * 3, 0.0f),
                     d_x = std::vector<float>(kN * 4 * 7, 0.0f);
};

std::vector<float> gradient_step_case(const Device& device) {
  GradientCase c;
  device.launch<GradientStep>({c.wide.data(), c.slope.data(), c.narrow.data(), 7, 5}, kN);
  return c.narrow;
}

std::vector<float> gradient_step_grad_case(const Device& device) {
  GradientCase c;
  device.launch<GradientStepGrad>(
      {c.wide.data(), c.slope.data(), c.curvature.data(), c.d_wide.data(), c.narrow.data(), 7, 5}, kN);
  c.narrow.insert(c.narrow.end(), c.d_wide.begin(), c.d_wide.end());
  return c.narrow;
}

std::vector<float> activate_grad_plus_case(const Device& device) {
  GradientCase c;
  device.launch<ActivateGradPlus>({c.slope.data(), c.narrow.data(), c.wide.data(), 7, 5}, kN);
  return c.wide;
}

std::vector<float> point_gradient_case(const Device& device) {
  GradientCase c;
  device.launch<PointGradient>({c.x.data(), c.wide.data(), c.y.data(), 7, 3, 5}, kN);
  return c.y;
}

std::vector<float> point_gradient_grad_case(const Device& device) {
  GradientCase c;
  device.launch<PointGradientGrad>(
      {c.x.data(), c.wide.data(), c.d_y.data(), c.d_wide.data(), c.d_x.data(), 7, 3, 5}, kN);
  c.d_x.insert(c.d_x.end(), c.d_wide.begin(), c.d_wide.end());
  return c.d_x;
}

std::vector<float> grid_case(const Device& device, int columns, uint32_t mask) {
  const auto points = noise(kN * 3, 3, 0.99f), table = noise(2 * 4913, 4);
  std::vector<float> out(kN * columns * 2);
  device.launch<EncodeGrid>({{points.data(), out.data(), 2, 0, columns}, {16, 17, mask}, table.data()}, kN);
  return out;
}

std::vector<float> grid_grad_case(const Device& device, int columns, uint32_t mask) {
  const auto points = noise(kN * 3, 3, 0.99f);
  auto d = noise(kN * columns * 2, 5);
  std::vector<float> table(2 * 4913, 0.0f);
  device.launch<EncodeGridGrad>({{points.data(), d.data(), 2, 0, columns}, {16, 17, mask}, table.data()}, kN);
  return table;
}

std::vector<float> adam_case(const Device& device, bool skip_zero) {
  auto value = noise(kN, 6), gradient = noise(kN, 7), m = noise(kN, 8, 0.1f), v = noise(kN, 9, 0.1f);
  for (float& x : v) x = std::abs(x);
  for (int i = 0; i < kN; i += 3) gradient[i] = 0;
  device.launch<Adam>(
      {{0.01f, 0.9f, 0.99f, 1e-8f, skip_zero}, value.data(), gradient.data(), m.data(), v.data()}, kN);
  value.insert(value.end(), m.begin(), m.end());
  value.insert(value.end(), v.begin(), v.end());
  value.insert(value.end(), gradient.begin(), gradient.end());
  return value;
}

// Another one for each sample.
Mat3f sample_rotation(int i) {
  return about_axis(normalize(Vec3f{1, 0.5f, -0.3f * float(i % 7)}), 0.37f * float(i));
}
std::vector<float> turned_panels() {  // [panels][9][32]
  std::vector<float> out(kN * 9);
  for (int i = 0; i < kN; ++i) store_rotation(out.data(), i, sample_rotation(i));
  return out;
}

constexpr int kFeatures = 4;
struct RadianceData {
  bool turned = false;
  std::vector<float> rotations = turned_panels();
  std::vector<float> points = noise(kN * 3, 10), directions = noise(kN * 3, 11),
                     jets = noise(kN * 4 * (1 + kFeatures), 12),
                     d_jets = std::vector<float>(kN * 4 * (1 + kFeatures), 0.0f),
                     input = std::vector<float>(kN * radiance_rows(kFeatures), 0.0f),
                     d_input = noise(kN * radiance_rows(kFeatures), 13);
  RadianceInput::Args forward() {
    return {points.data(), directions.data(), jets.data(), input.data(), kFeatures, turns()};
  }
  RadianceInputGrad::Args gradient() {
    return {directions.data(), jets.data(), d_input.data(), d_jets.data(), kFeatures, turns()};
  }
  const float* turns() const { return turned ? rotations.data() : nullptr; }
};

std::vector<float> radiance_case(const Device& device, bool gradient, bool turned) {
  RadianceData d{turned};
  gradient ? device.launch<RadianceInputGrad>(d.gradient(), kN)
           : device.launch<RadianceInput>(d.forward(), kN);
  return gradient ? d.d_jets : d.input;
}

std::vector<float> point_case(const Device& device, int columns) {
  const auto points = noise(kN * 3, 14);
  std::vector<float> out(kN * columns * 5);
  device.launch<EncodePoint>({points.data(), out.data(), 5, 1, columns}, kN);
  return out;
}

std::vector<float> frequency_case(const Device& device, int k) {
  const auto points = noise(kN * 3, 14);
  std::vector<float> out(kN * 4 * 6);
  device.launch<EncodeFrequency>({{points.data(), out.data(), 6, 0, 4}, k}, kN);
  return out;
}

std::vector<float> linear_case(const Device& device, int in, int out) {
  const auto x = noise(size_t(kN) * in, 15), w = noise(size_t(in) * out, 16), b = noise(out, 17);
  std::vector<float> y(size_t(kN) * out);
  device.linear({kN / kPanel, in, out, x.data(), in, w.data(), in, b.data(), y.data(), out});
  return y;
}

// Hits of rays that enter a surface, some of them grazing it.
std::vector<float> field_hit_case(const Device& device, bool gradient) {
  std::vector<float> depths = noise(kN, 18), positions = noise(3 * kN, 19), directions = noise(3 * kN, 20),
                     gradients = noise(3 * kN, 21, 0.3f);
  const std::vector<float> values = noise(kN, 22, 0.1f), along = noise(3 * kN, 23), d_depths = noise(kN, 24),
                           d_positions = noise(3 * kN, 25), d_normals = noise(3 * kN, 26);
  for (int i = 0; i < kN; ++i) {
    const Vec3f d = normalize(load_planes<float>(directions.data(), kN, i));
    store_planes(directions.data(), kN, i, d);
    store_planes(gradients.data(), kN, i, load_planes<float>(gradients.data(), kN, i) - d * 0.5f);
  }
  std::vector<float> out(7 * kN);
  const TracedHitPlanes hits{
      kN, depths.data(), positions.data(), directions.data(), values.data(), gradients.data(), along.data()};
  if (gradient)
    device.launch<FieldHitsGrad>(
        {hits, d_depths.data(), d_positions.data(), d_normals.data(), out.data(), out.data() + kN}, kN);
  else
    device.launch<FieldHits>({hits, out.data(), out.data() + kN, out.data() + 4 * kN}, kN);
  return out;
}

// The cases of kernel K. A kernel without any does not compile: add a specialization.
template <class K>
struct Parity;

using Cases = std::vector<Case>;
template <class A>
struct Parity<Activate<A>> {
  static Cases cases() {
    return {{"forward", [](const Device& d) { return activation_case<A>(d, false); }}};
  }
};
template <class A>
struct Parity<ActivateGrad<A>> {
  static Cases cases() {
    return {{"gradient", [](const Device& d) { return activation_case<A>(d, true); }}};
  }
};
template <class A>
struct Parity<ActivateTwice<A>> {
  static Cases cases() { return {{"", activate_twice_case<A>}}; }
};
template <>
struct Parity<GradientStep> {
  static Cases cases() { return {{"", gradient_step_case}}; }
};
template <>
struct Parity<GradientStepGrad> {
  static Cases cases() { return {{"", gradient_step_grad_case}}; }
};
template <>
struct Parity<ActivateGradPlus> {
  static Cases cases() { return {{"", activate_grad_plus_case}}; }
};
template <>
struct Parity<PointGradient> {
  static Cases cases() { return {{"", point_gradient_case}}; }
};
template <>
struct Parity<PointGradientGrad> {
  static Cases cases() { return {{"", point_gradient_grad_case}}; }
};
template <>
struct Parity<EncodePoint> {
  static Cases cases() {
    return {{"values", [](const Device& d) { return point_case(d, 1); }},
            {"jets", [](const Device& d) { return point_case(d, 4); }}};
  }
};
template <>
struct Parity<EncodeFrequency> {
  static Cases cases() {
    return {{"0", [](const Device& d) { return frequency_case(d, 0); }},
            {"9", [](const Device& d) { return frequency_case(d, 9); }}};
  }
};
template <>
struct Parity<EncodeGrid> {
  static Cases cases() {
    return {{"dense", [](const Device& d) { return grid_case(d, 1, 0); }},
            {"dense, jets", [](const Device& d) { return grid_case(d, 4, 0); }},
            {"hashed, jets", [](const Device& d) { return grid_case(d, 4, 1023); }}};
  }
};
template <>
struct Parity<EncodeGridGrad> {
  static Cases cases() {
    return {{"dense", [](const Device& d) { return grid_grad_case(d, 1, 0); }},
            {"hashed, jets", [](const Device& d) { return grid_grad_case(d, 4, 1023); }}};
  }
};
template <>
struct Parity<Adam> {
  static Cases cases() {
    return {{"all", [](const Device& d) { return adam_case(d, false); }},
            {"zeros skipped", [](const Device& d) { return adam_case(d, true); }}};
  }
};
template <>
struct Parity<RadianceInput> {
  static Cases cases() {
    return {{"", [](const Device& d) { return radiance_case(d, false, false); }},
            {"turned", [](const Device& d) { return radiance_case(d, false, true); }}};
  }
};
template <>
struct Parity<RadianceInputGrad> {
  static Cases cases() {
    return {{"", [](const Device& d) { return radiance_case(d, true, false); }},
            {"turned", [](const Device& d) { return radiance_case(d, true, true); }}};
  }
};

template <>
struct Parity<FieldHits> {
  static Cases cases() {
    return {{"", [](const Device& d) { return field_hit_case(d, false); }}};
  }
};
template <>
struct Parity<FieldHitsGrad> {
  static Cases cases() {
    return {{"", [](const Device& d) { return field_hit_case(d, true); }}};
  }
};

// Kernels whose cases are in shade_kernels_test.cpp.
using ShadeKernels = KernelList<SgFitResidual, SgFitGather, SgIrradiance, SgReflection, SgReflectionGrad,
                                ReflectionLobes, SgLobesGrad, Shade, ShadeGrad>;

template <class K>
void append_cases(Cases& out) {
  if constexpr (ShadeKernels::index_of<K>() < 0)
    for (Case c : Parity<K>::cases()) out.push_back({typeid(K).name() + (" " + c.name), c.run});
}
template <class... K>
Cases cases_of(KernelList<K...>) {
  Cases out;
  (append_cases<K>(out), ...);
  return out;
}

void expect_parity(const Case& c) {
  const std::vector<Device> devices = all_devices();
  const std::vector<float> want = c.run(devices[0]);
  double scale = 1e-6;
  for (float v : want) scale = std::max(scale, double(std::abs(v)));
  for (const Device& device : devices) {
    const std::vector<float> got = c.run(device);
    double worst = 0;
    for (size_t i = 0; i < want.size(); ++i) worst = std::max(worst, double(std::abs(got[i] - want[i])));
    EXPECT_LT(worst / scale, 1e-5) << c.name << " on " << device.name();
  }
}

TEST(Kernels, EveryDeviceAgreesWithTheScalarOne) {
  const Cases cases = cases_of(AllKernels{});
  EXPECT_GT(cases.size(), 15u);
  for (const Case& c : cases) expect_parity(c);
}

TEST(Linear, EveryDeviceAgreesWithTheScalarOne) {
  expect_parity({"7 to 13", [](const Device& d) { return linear_case(d, 7, 13); }});
  expect_parity({"64 to 64", [](const Device& d) { return linear_case(d, 64, 64); }});
}

TEST(Kernels, EncodePointWritesThePointAndItsUnitJet) {
  const auto points = noise(kN * 3, 14);
  const std::vector<float> out = point_case(make_device("cpu/scalar"), 4);
  for (int i = 0; i < kN; ++i)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        EXPECT_EQ(out[panel_at(i, 4, c, 5, 1 + r)],
                  c == 0 ? points[panel_at(i, 1, 0, 3, r)] : float(c == 1 + r));
}

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

TEST(Kernels, TurnedRadianceInputIsThatOfTurnedNormalsAndDirections) {
  const Device device = make_device("cpu/scalar");
  RadianceData turned{.turned = true}, by_hand;
  for (int i = 0; i < kN; ++i) {
    const Mat3f r = sample_rotation(i);
    store_point(by_hand.directions.data(), i, r * load_point<float>(turned.directions.data(), i));
    const Vec3f g = r * load_sdf_gradient<float>(turned.jets.data(), i, 1 + kFeatures);
    for (int c = 0; c < 3; ++c) by_hand.jets[panel_at(i, 4, 1 + c, 1 + kFeatures, 0)] = g[c];
  }
  device.launch<RadianceInput>(turned.forward(), kN);
  device.launch<RadianceInput>(by_hand.forward(), kN);
  for (size_t k = 0; k < turned.input.size(); ++k) EXPECT_NEAR(turned.input[k], by_hand.input[k], 2e-4f);
}

TEST(Kernels, RadianceInputGradientEqualsFiniteDifferences) {
  expect_radiance_gradient({});
  expect_radiance_gradient({.turned = true});
}

void expect_plain_loops(int in, int out, int panels) {
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
    for (int k = 0; k < in * out; ++k) EXPECT_NEAR(d_w[k], want_w[k], 1e-4) << device.name();
    for (int o = 0; o < out; ++o) EXPECT_NEAR(d_b[o], want_b[o], 1e-4);
  }
}

TEST(Linear, EqualsPlainLoops) {
  expect_plain_loops(9, 6, 8);
  expect_plain_loops(41, 13, 24);  // more than a block of weight gradients, either way; tiles of every height
}

TEST(Kernels, FlushDenormalsOnlyForThemselves) {
  volatile float small = 2e-38f, third = 0.3f;  // their product is denormal
  for (const Device& device : all_devices()) {
    const std::vector<float> x(kPanel, float(small)), weight{third};
    std::vector<float> y(kPanel, 1.0f);
    device.linear({1, 1, 1, x.data(), 1, weight.data(), 1, nullptr, y.data(), 1});
    EXPECT_EQ(y[0], 0) << device.name();
    EXPECT_GT(small * third, 0) << device.name();
  }
}

TEST(Device, UnknownNamesAreUsageErrors) {
  EXPECT_THROW(make_device("cuda:7"), Error);
  EXPECT_EQ(make_device("cpu/scalar").name(), "cpu/scalar");
}

}  // namespace
}  // namespace cei3d
