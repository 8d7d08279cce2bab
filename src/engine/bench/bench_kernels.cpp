// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <map>

#include "core/base/aligned.h"
#include "core/base/error.h"
#include "core/base/system.h"
#include "core/compute/kernels/encode.h"
#include "core/math/rng.h"
#include "engine/bench/bench.h"
#include "model/field/field_pass.h"

namespace cei3d {
namespace {

constexpr const char* kFma = "multiply-add peak";
constexpr const char* kGather = "gather peak";
constexpr const char* kScatter = "read-modify-write peak";

struct LinearData {
  // 64 panels of 64 rows: what a training chunk passes on.
  static constexpr int kPanels = 64, kSize = 64, kRounds = 40;
  AlignedVector<float> x = AlignedVector<float>(size_t(kPanels) * kSize * kPanel, 0.5f), y = x,
                       w = AlignedVector<float>(size_t(kSize) * kSize, 0.01f), d_w = w,
                       bias = AlignedVector<float>(kSize, 0.1f);
  static constexpr double flops() { return 2.0 * kPanels * kPanel * kSize * kSize * kRounds; }
};

double linear_forward(const Device& device, LinearData& d) {
  for (int k = 0; k < d.kRounds; ++k)
    device.linear({d.kPanels, d.kSize, d.kSize, d.x.data(), d.kSize, d.w.data(), d.kSize, d.bias.data(),
                   d.y.data(), d.kSize});
  return d.flops();
}

double linear_weights(const Device& device, LinearData& d) {
  for (int k = 0; k < d.kRounds; ++k)
    device.linear_weight_grad({d.kPanels, d.kSize, d.kSize, d.x.data(), d.kSize, d.y.data(), d.kSize,
                               d.d_w.data(), d.kSize, nullptr});
  return d.flops();
}

struct GridData {
  static constexpr int kSamples = 2048, kRounds = 400;
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

// Bytes read and written by copies of arrays larger than the caches.
double copy_bytes(std::vector<char>& a, std::vector<char>& b) {
  std::memcpy(b.data(), a.data(), a.size());
  std::swap(a, b);
  return 2.0 * double(a.size());
}

struct Kernel {
  const char* group;
  std::string name;
  const char* unit;
  double per;                      // of the unit: 1e9 for GFLOP/s
  std::vector<const char*> peaks;  // names of kernels that it is compared with
  std::function<double()> run;     // returns the work done
};

// Work per second of this thread's processor time. Kernels run in turn, round after round, so that a
// disturbance affects all of them and shows in their spread. The first round is a warm-up and is not counted.
std::vector<Spread> measure(const std::vector<Kernel>& kernels, int repeats) {
  std::vector<std::vector<double>> rates(kernels.size());
  for (int k = 0; k <= repeats; ++k)
    for (size_t i = 0; i < kernels.size(); ++i) {
      const double begin = thread_seconds(), work = kernels[i].run();
      if (k > 0) rates[i].push_back(work / (thread_seconds() - begin) / kernels[i].per);
    }
  std::vector<Spread> spreads;
  for (std::vector<double>& r : rates) spreads.push_back(spread_of(std::move(r), true));
  return spreads;
}

std::vector<BenchFigure> figures_of(const std::vector<Kernel>& kernels, const std::vector<Spread>& spreads) {
  std::map<std::string, double> best;  // in the same unit as what is compared with it
  for (size_t i = 0; i < kernels.size(); ++i) best[kernels[i].name] = spreads[i].best;
  std::vector<BenchFigure> figures;
  for (size_t i = 0; i < kernels.size(); ++i) {
    BenchFigure f{kernels[i].group, "", kernels[i].name, kernels[i].unit, true, spreads[i], {}};
    for (const char* peak : kernels[i].peaks) f.of.emplace_back(peak, spreads[i].best / best.at(peak));
    figures.push_back(std::move(f));
  }
  std::stable_sort(figures.begin(), figures.end(), [](const BenchFigure& a, const BenchFigure& b) {
    return (a.group == "machine") > (b.group == "machine");
  });
  return figures;
}

void add_grids(const Device& device, GridData& grid, std::vector<Kernel>& kernels) {
  const std::string size = fmt::format(", table 2^{}", std::bit_width(grid.level.hash_mask));
  const char* unit = "M pairs/s";
  kernels.push_back({"machine", "gather, random places" + size, unit, 1e6, {kGather}, [&device, &grid] {
                       return device.gather_peak(grid.table.data(), grid.level.hash_mask);
                     }});
  kernels.push_back(
      {"machine", "read-modify-write, random places" + size, unit, 1e6, {kScatter}, [&device, &grid] {
         return device.scatter_peak(grid.d_table.data(), grid.level.hash_mask);
       }});
  kernels.push_back({"kernels", "hash encoding, values" + size, unit, 1e6, {kGather}, [&device, &grid] {
                       return grid_forward(device, grid, 1);
                     }});
  kernels.push_back({"kernels", "hash encoding, jets" + size, unit, 1e6, {kGather}, [&device, &grid] {
                       return grid_forward(device, grid, 4);
                     }});
  kernels.push_back(
      {"kernels", "hash encoding, jet backward" + size, unit, 1e6, {kScatter, kGather}, [&device, &grid] {
         return grid_backward(device, grid);
       }});
}

}  // namespace

std::vector<BenchFigure> bench_kernels(const Device& device, int repeats) {
  // A table that stays in the first-level cache: no encoding can be faster, however its corners lie.
  std::vector<float> small(2 * 1024, 1.0f);
  std::vector<char> from(size_t(96) << 20, 1), to(from.size(), 2);
  LinearData linear;
  GridData grid15(15), grid17(17);
  std::vector<Kernel> kernels{
      {"machine", kFma, "GFLOP/s", 1e9, {}, [&] { return device.fma_peak(); }},
      {"machine", kGather, "M pairs/s", 1e6, {}, [&] { return device.gather_peak(small.data(), 1023); }},
      {"machine", kScatter, "M pairs/s", 1e6, {}, [&] { return device.scatter_peak(small.data(), 1023); }},
      {"machine", "memory copy", "GB/s", 1e9, {}, [&] { return copy_bytes(from, to); }},
      {"kernels",
       "linear 64x64, forward",
       "GFLOP/s",
       1e9,
       {kFma},
       [&] { return linear_forward(device, linear); }},
      {"kernels", "linear 64x64, weight gradient", "GFLOP/s", 1e9, {kFma}, [&] {
         return linear_weights(device, linear);
       }}};
  add_grids(device, grid15, kernels);
  add_grids(device, grid17, kernels);
  return figures_of(kernels, measure(kernels, repeats));
}

}  // namespace cei3d
