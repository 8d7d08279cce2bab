// SPDX-License-Identifier: Apache-2.0
// Inputs of kernels for tests, and the comparison of devices.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/compute/device.h"
#include "core/compute/kernels/all.h"
#include "core/math/rng.h"
#include "core/math/rotation.h"

namespace cei3d {

inline std::vector<float> noise(size_t n, uint64_t seed, float scale = 1) {
  std::vector<float> v(n);
  for (size_t i = 0; i < n; ++i) v[i] = scale * (2 * Rng(seed, 0, i).uniform() - 1);
  return v;
}

inline constexpr int kN = 96;  // samples: three panels

// Runs one kernel and returns all that it wrote.
struct Case {
  std::string name;
  std::function<std::vector<float>(const Device&)> run;
};

// Every device of this machine gives the numbers of the scalar one, up to `tolerance` of the largest.
inline void expect_parity(const Case& c, double tolerance = 1e-5) {
  const std::vector<float> want = c.run(make_device("cpu/scalar"));
  double scale = 1e-6;
  for (const float v : want) scale = std::max(scale, double(std::abs(v)));
  for (const Device& device : all_devices()) {
    const std::vector<float> got = c.run(device);
    ASSERT_EQ(got.size(), want.size());
    const auto error_at = [&](size_t i) {
      const double error = std::abs(double(got[i]) - want[i]) / scale;
      return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    };
    size_t worst = 0;
    for (size_t i = 0; i < want.size(); ++i)
      if (error_at(i) > error_at(worst)) worst = i;
    EXPECT_LT(error_at(worst), tolerance) << c.name << " on " << device.name() << ": number " << worst
                                          << " is " << got[worst] << " instead of " << want[worst];
    testing::Test::RecordProperty(c.name + " on " + device.name(),
                                  std::to_string(1e6 * error_at(worst)) + " millionths");
  }
}

namespace scalar {
extern const LaunchTable table;
}
template <class K>
inline int launches_of = 0;  // by a device of CountedEntries
template <class K>
void launch_counted(const void* args, int n) {
  ++launches_of<K>;
  scalar::table.kernels[kernel_index<K>()](args, n);
}
template <class List>
struct CountedEntries;
template <class... K>
struct CountedEntries<KernelList<K...>> {
  static constexpr void (*entries[])(const void*, int) = {&launch_counted<K>...};
};

// The names of those kernels that the cases do not launch.
template <class... K>
std::string never_launched(KernelList<K...>, const std::vector<Case>& cases) {
  LaunchTable counting = scalar::table;
  counting.kernels = CountedEntries<AllKernels>::entries;
  ((launches_of<K> = 0), ...);
  for (const Case& c : cases) c.run(Device(counting));
  std::string names;
  ((launches_of<K> > 0 ? names : names.append(typeid(K).name()).append(" ")), ...);
  return names;
}

// Kernels whose cases are in shade_kernels_test.cpp.
using ShadeKernels =
    KernelList<SgFitResidual, SgFitGather, SgIrradiance, SgReflection, SgReflectionGrad, ReflectionLobes,
               SgLobesGrad, Shade, ShadeGrad, SgMirror, SgMirrorGrad, SgMirrorLobesGrad>;

// Another one for each sample.
inline Mat3f sample_rotation(int i) {
  return about_axis(normalize(Vec3f{1, 0.5f, -0.3f * float(i % 7)}), 0.37f * float(i));
}
inline std::vector<float> turned_panels() {  // [panels][9][32]
  std::vector<float> out(kN * 9);
  for (int i = 0; i < kN; ++i) store_rotation(out.data(), i, sample_rotation(i));
  return out;
}

inline constexpr int kFeatures = 4;
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

}  // namespace cei3d
