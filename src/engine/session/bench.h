// SPDX-License-Identifier: Apache-2.0
// How fast the kernels are on this machine, as fractions of what the machine itself was measured to do.
#pragma once

#include <string>
#include <vector>

#include "core/compute/device.h"

namespace cei3d {

struct BenchRow {
  std::string name;
  double rate;  // best of several runs, on one core
  std::string unit;
  double of_peak;  // fraction of the peak of its kind; 1 for the peaks themselves
};

// A few seconds on one core.
std::vector<BenchRow> bench_kernels(const Device&);

}  // namespace cei3d
