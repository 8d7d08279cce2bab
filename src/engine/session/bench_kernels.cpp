// SPDX-License-Identifier: Apache-2.0
#include <time.h>

#include <cstring>
#include <functional>

#include "core/math/rng.h"
#include "engine/session/bench.h"
#include "model/field/field_pass.h"

namespace cei3d {
namespace {

constexpr const char* kFma = "multiply-add peak";
constexpr const char* kGather = "gather peak";
constexpr const char* kScatter = "read-modify-write peak";

double processor_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Work a second of this thread's processor time: others may use the cores as well. The first run, which warms
// caches and clocks, does not count.
Spread rate(int repeats, const std::function<double()>& run) {
  run();
  std::vector<double> rates;
  for (int k = 0; k < repeats; ++k) {
    const double begin = processor_seconds(), work = run();
    rates.push_back(work / (processor_seconds() - begin));
  }
  return spread_of(std::move(rates), true);
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

// Bytes read and written by copies of more than caches hold.
double copy_bytes(std::vector<char>& a, std::vector<char>& b) {
  std::memcpy(b.data(), a.data(), a.size());
  std::swap(a, b);
  return 2.0 * double(a.size());
}

class Table {
 public:
  explicit Table(int repeats) : repeats_(repeats) {}
  // per: what the unit is in, 1e9 for GFLOP/s. Returns the rate itself.
  Spread add(const char* group, const std::string& name, const char* unit, double per,
             std::vector<std::pair<std::string, Spread>> peaks, const std::function<double()>& run) {
    const Spread s = rate(repeats_, run);
    BenchFigure f{group, "", name, unit, true, {s.median / per, s.deviation / per, s.best / per, s.repeats},
                  {}};
    for (const auto& [peak, spread] : peaks) f.of.emplace_back(peak, s.best / spread.best);
    figures_.push_back(std::move(f));
    return s;
  }
  std::vector<BenchFigure> take() { return std::move(figures_); }

 private:
  int repeats_;
  std::vector<BenchFigure> figures_;
};

void add_grids(Table& table, const Device& device, int log2_table, const Spread& gather,
               const Spread& scatter) {
  GridData grid(log2_table);
  const std::string size = ", table 2^" + std::to_string(log2_table);
  const char* unit = "M pairs/s";
  table.add("machine", "gather, random places" + size, unit, 1e6, {{kGather, gather}},
            [&] { return device.gather_peak(grid.table.data(), grid.level.hash_mask); });
  table.add("machine", "read-modify-write, random places" + size, unit, 1e6, {{kScatter, scatter}},
            [&] { return device.scatter_peak(grid.d_table.data(), grid.level.hash_mask); });
  table.add("kernels", "hash encoding, values" + size, unit, 1e6, {{kGather, gather}},
            [&] { return grid_forward(device, grid, 1); });
  table.add("kernels", "hash encoding, jets" + size, unit, 1e6, {{kGather, gather}},
            [&] { return grid_forward(device, grid, 4); });
  table.add("kernels", "hash encoding, jet backward" + size, unit, 1e6,
            {{kScatter, scatter}, {kGather, gather}}, [&] { return grid_backward(device, grid); });
}

}  // namespace

std::vector<BenchFigure> bench_kernels(const Device& device, int repeats) {
  Table table(repeats);
  const Spread fma = table.add("machine", kFma, "GFLOP/s", 1e9, {}, [&] { return device.fma_peak(); });
  // In tables that stay in the first-level cache: no encoding can be faster, however its corners lie.
  std::vector<float> small(2 * 1024, 1.0f);
  const Spread gather = table.add("machine", kGather, "M pairs/s", 1e6, {},
                                  [&] { return device.gather_peak(small.data(), 1023); });
  const Spread scatter = table.add("machine", kScatter, "M pairs/s", 1e6, {},
                                   [&] { return device.scatter_peak(small.data(), 1023); });
  std::vector<char> from(size_t(96) << 20, 1), to(from.size(), 2);
  table.add("machine", "memory copy", "GB/s", 1e9, {}, [&] { return copy_bytes(from, to); });
  LinearData linear;
  table.add("kernels", "linear 64x64, forward", "GFLOP/s", 1e9, {{kFma, fma}},
            [&] { return linear_forward(device, linear); });
  table.add("kernels", "linear 64x64, weight gradient", "GFLOP/s", 1e9, {{kFma, fma}},
            [&] { return linear_weights(device, linear); });
  for (const int log2_table : {15, 17}) add_grids(table, device, log2_table, gather, scatter);
  std::vector<BenchFigure> figures = table.take();
  std::stable_sort(figures.begin(), figures.end(), [](const BenchFigure& a, const BenchFigure& b) {
    return (a.group == "machine") > (b.group == "machine");
  });
  return figures;
}

}  // namespace cei3d
