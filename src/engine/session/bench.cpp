// SPDX-License-Identifier: Apache-2.0
#include "engine/session/bench.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include "core/math/rng.h"
#include "model/field/field_pass.h"

namespace cei3d {

namespace {

// Work a second, best of several runs: others share the machine, and only ever make a run slower.
double best_rate(const std::function<double()>& run) {
  double best = 0;
  for (int k = 0; k < 7; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const double work = run();
    best = std::max(best,
                    work / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

struct LinearData {
  static constexpr int kPanels = 64, kSize = 64,
                       kRounds = 40;  // 64 panels of 64 rows: what a training chunk passes on
  std::vector<float> x = std::vector<float>(size_t(kPanels) * kSize * kPanel, 0.5f), y = x,
                     w = std::vector<float>(size_t(kSize) * kSize, 0.01f), d_w = w,
                     bias = std::vector<float>(kSize, 0.1f);
  static constexpr double flops() { return 2.0 * kPanels * kPanel * kSize * kSize * kRounds; }
};

double linear_forward(const Device& device, LinearData& d) {
  for (int k = 0; k < d.kRounds; ++k)
    device.linear({d.kPanels, d.kSize, d.kSize, d.x.data(), d.kSize, d.w.data(), d.kSize, d.bias.data(), 1,
                   d.y.data(), d.kSize});
  return d.flops();
}

double linear_weights(const Device& device, LinearData& d) {
  for (int k = 0; k < d.kRounds; ++k)
    device.linear_weight_grad({d.kPanels, d.kSize, d.kSize, d.x.data(), d.kSize, d.y.data(), d.kSize,
                               d.d_w.data(), d.kSize, nullptr, 1});
  return d.flops();
}

struct GridData {
  static constexpr int kSamples = 2048, kRounds = 40;
  explicit GridData(int log2_table)
      : level{200, 201, (1u << log2_table) - 1}, table(size_t(2) << log2_table, 0.1f), d_table(table) {
    for (size_t i = 0; i < points.size(); ++i) points[i] = 2 * Rng(1, 0, i).uniform() - 1;
  }
  GridLevel level;
  std::vector<float> table, d_table, points = std::vector<float>(3 * kSamples),
                                     out = std::vector<float>(2 * 4 * kSamples, 0.1f);
};

// Gathers of a corner's two features.
double grid_forward(const Device& device, GridData& d, int columns) {
  for (int k = 0; k < d.kRounds; ++k)
    device.launch<EncodeGrid>({{d.points.data(), d.out.data(), 2, 0, columns}, d.level, d.table.data()},
                              d.kSamples);
  return 8.0 * d.kSamples * d.kRounds;
}

double grid_backward(const Device& device, GridData& d) {
  for (int k = 0; k < d.kRounds; ++k)
    device.launch<EncodeGridGrad>({{d.points.data(), d.out.data(), 2, 0, 4}, d.level, d.d_table.data()},
                                  d.kSamples);
  return 8.0 * d.kSamples * d.kRounds;
}

}  // namespace

std::vector<BenchRow> bench_kernels(const Device& device) {
  std::vector<BenchRow> rows;
  const double fma = best_rate([&] { return device.fma_peak(); });
  rows.push_back({"multiply-add peak", fma / 1e9, "GFLOP/s", 1});
  LinearData linear;
  const auto add = [&](const char* name, double rate, const char* unit, double peak) {
    rows.push_back({name, rate / (peak == fma ? 1e9 : 1e6), unit, rate / peak});
  };
  add("linear 64x64, forward", best_rate([&] { return linear_forward(device, linear); }), "GFLOP/s", fma);
  add("linear 64x64, weight gradient", best_rate([&] { return linear_weights(device, linear); }), "GFLOP/s",
      fma);
  // From a table that stays in the first-level cache: no encoding can gather faster, however its corners lie.
  const std::vector<float> small(2 * 1024, 1.0f);
  const double gather = best_rate([&] { return device.gather_peak(small.data(), 1023); });
  rows.push_back({"gather peak (8-byte pairs)", gather / 1e6, "M gathers/s", 1});
  for (const int log2_table : {15, 17}) {
    GridData grid(log2_table);
    const std::string size = " (table 2^" + std::to_string(log2_table) + ")";
    const double scattered =
        best_rate([&] { return device.gather_peak(grid.table.data(), grid.level.hash_mask); });
    rows.push_back({"gather, random places" + size, scattered / 1e6, "M gathers/s", scattered / gather});
    add(("hash encoding, values" + size).c_str(), best_rate([&] { return grid_forward(device, grid, 1); }),
        "M gathers/s", gather);
    add(("hash encoding, jets" + size).c_str(), best_rate([&] { return grid_forward(device, grid, 4); }),
        "M gathers/s", gather);
    add(("hash encoding, jet backward" + size).c_str(),
        best_rate([&] { return grid_backward(device, grid); }), "M scatters/s", gather);
  }
  return rows;
}

}  // namespace cei3d
