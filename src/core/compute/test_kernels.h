// SPDX-License-Identifier: Apache-2.0
// Inputs of kernels for tests, and the comparison of devices.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
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

// Every device of this machine gives the numbers of the scalar one.
inline void expect_parity(const Case& c) {
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
