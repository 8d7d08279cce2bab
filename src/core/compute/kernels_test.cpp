// SPDX-License-Identifier: Apache-2.0
// Every kernel on every device of this machine against the scalar one.
#include <gtest/gtest.h>

#include <cmath>
#include <typeinfo>

#include "core/base/error.h"
#include "core/compute/test_kernels.h"

namespace cei3d {
namespace {

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
  std::vector<float> wide = noise(kN * 7, 30), first = noise(kN * 5, 31), second = noise(kN * 5, 32),
                     d_wide = noise(kN * 7, 33), narrow = noise(kN * 5, 34), x = noise(kN * 4 * 7, 35),
                     d_y = noise(kN * 4 * 3, 36), y = std::vector<float>(kN * 4 * 3, 0.0f),
                     d_x = std::vector<float>(kN * 4 * 7, 0.0f);
};

std::vector<float> gradient_step_case(const Device& device) {
  GradientCase c;
  device.launch<GradientStep>({c.wide.data(), c.first.data(), c.narrow.data(), 7, 5}, kN);
  return c.narrow;
}

std::vector<float> gradient_step_grad_case(const Device& device) {
  GradientCase c;
  device.launch<GradientStepGrad>(
      {c.wide.data(), c.first.data(), c.second.data(), c.d_wide.data(), c.narrow.data(), 7, 5}, kN);
  c.narrow.insert(c.narrow.end(), c.d_wide.begin(), c.d_wide.end());
  return c.narrow;
}

std::vector<float> activate_grad_plus_case(const Device& device) {
  GradientCase c;
  device.launch<ActivateGradPlus>({c.first.data(), c.narrow.data(), c.wide.data(), 7, 5}, kN);
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

template <class K>
void append_cases(Cases& out) {
  if constexpr (ShadeKernels::index_of<K>() < 0) {
    EXPECT_EQ(never_launched(KernelList<K>{}, Parity<K>::cases()), "");
    for (Case c : Parity<K>::cases()) out.push_back({typeid(K).name() + (" " + c.name), c.run});
  }
}
template <class... K>
Cases cases_of(KernelList<K...>) {
  Cases out;
  (append_cases<K>(out), ...);
  return out;
}

TEST(Kernels, EveryDeviceAgreesWithTheScalarOne) {
  const Cases cases = cases_of(AllKernels{});
  EXPECT_GT(cases.size(), 15u);
  for (const Case& c : cases) expect_parity(c);
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

TEST(Device, UnknownNamesAreUsageErrors) {
  EXPECT_THROW(make_device("cuda:7"), Error);
  EXPECT_EQ(make_device("cpu/scalar").name(), "cpu/scalar");
}

}  // namespace
}  // namespace cei3d
