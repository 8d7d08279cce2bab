// SPDX-License-Identifier: Apache-2.0
// Speed of the kernels on a card, as shares of what the card can do at most and beside this machine's CPU.
// Exit code 77: no card.
#include <cmath>
#include <cstdio>
#include <exception>

#include "core/base/parallel.h"
#include "core/compute/cuda/bench_report.h"
#include "core/compute/cuda/device.h"
#include "core/compute/cuda/launch.h"
#include "core/compute/cuda/linear.h"
#include "core/compute/cuda/peaks.h"
#include "core/math/rng.h"

namespace cei3d::cuda {
namespace {

constexpr int kSamples = 1 << 20;
constexpr const char *kCopy = "copy", *kFma = "multiply-add";

float unit_noise(uint64_t seed, size_t i) { return Rng(seed, 0, i).uniform(); }  // [0, 1)
Twin noise(size_t n, uint64_t seed, float scale = 1) {
  return Twin(n, [=](size_t i) { return scale * (2 * unit_noise(seed, i) - 1); });
}
std::string sized(const char* name, int log2_table) {
  return name + std::string(", 2^") + std::to_string(log2_table);
}

// scatter_add2() with both numbers at once, which cards of capability 9.0 offer.
__global__ void pair_scatter_loop(float* pairs, uint32_t mask) {
  RandomPlaces places(mask);
  for (int i = 0; i < kPeakPlaces; ++i) {
#if __CUDA_ARCH__ >= 900
    atomicAdd(reinterpret_cast<float2*>(pairs) + places.next(), make_float2(1e-6f, -1e-6f));
#else
    scatter_add2(pairs, places.next(), 1e-6f, -1e-6f);
#endif
  }
}

void measure_machine(Report& report) {
  constexpr size_t kBytes = size_t(1) << 30;
  Twin from(kBytes / sizeof(float)), to(kBytes / sizeof(float));
  report.measure({kCopy, "GB/s", 2e-9 * kBytes, [&] {
                    check(cudaMemcpyAsync(to.on_card(), from.on_card(), kBytes, cudaMemcpyDeviceToDevice),
                          "copy");
                  }});
  // The amounts are known only when a loop is in line.
  const double flops = enqueue_fma_peak();
  report.measure({kFma, "TFLOP/s", 1e-12 * flops, [] { enqueue_fma_peak(); }});
  const double places = double(kPeakPlaces) * kPeakThreads * peak_blocks();
  for (const int log2_table : {15, 19}) {
    const uint32_t mask = (1u << log2_table) - 1;
    report.measure({sized("gather", log2_table), "G pairs/s", 1e-9 * places,
                    [&] { enqueue_gather_peak(from.on_card(), mask); }});
    report.measure({sized("add", log2_table), "G pairs/s", 1e-9 * places,
                    [&] { enqueue_scatter_peak(to.on_card(), mask); }});
    if (card().capability >= 90)
      report.measure({sized("add, both numbers at once", log2_table), "G pairs/s", 1e-9 * places, [&] {
                        pair_scatter_loop<<<peak_blocks(), kPeakThreads>>>(to.on_card(), mask);
                        check(cudaGetLastError(), "scatter peak of pairs");
                      }});
  }
}

// What each launch costs that the caller waits for: the length of the smallest useful piece of work.
void measure_waiting(Report& report) {
  constexpr int kLaunches = 100;
  Twin x(32, 1.0f), y(32);
  const Device device(table);
  report.measure({"100 launches that are waited for", "M/s", 1e-6 * kLaunches, [&] {
                    for (int k = 0; k < kLaunches; ++k)
                      device.launch<Activate<Relu>>({x.on_card(), y.on_card(), 1, 1, 1, 1}, kPanel);
                  }});
}

struct LinearWork {
  static constexpr int kPanels = kSamples / kPanel, kGrain = 64, kChunks = 64;
  int in, out;
  Twin x = noise(size_t(kSamples) * in, 1), y = noise(size_t(kSamples) * out, 2),
       w = noise(size_t(in) * out, 3), bias = noise(out, 4), d_w = Twin(size_t(in) * out), d_bias = Twin(out);
  Twin w_transposed = Twin(size_t(in) * out, [this](size_t k) { return w.on_cpu()[k % out * in + k / out]; });

  LinearArgs forward(bool card) {
    const auto of = [card](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    return {kPanels, in, out, of(x), in, of(w), in, of(bias), of(y), out};
  }
  LinearArgs backward(bool card) {  // x is what is written
    const auto of = [card](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    return {kPanels, out, in, of(y), out, of(w_transposed), out, nullptr, of(x), in};
  }
  LinearWeightGradArgs weights(bool card) {
    const auto of = [card](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    return {kPanels, in, out, of(x), in, of(y), out, of(d_w), in, of(d_bias)};
  }
};

void linear_on_threads(const Device& cpu, const LinearArgs& all) {
  parallel_ranges(all.panels, LinearWork::kGrain, [&](int begin, int end) {
    LinearArgs a = all;
    a.panels = end - begin;
    a.x += size_t(begin) * a.x_stride * kPanel;
    a.y += size_t(begin) * a.y_stride * kPanel;
    cpu.linear(a);
  });
}

// Chunks of panels have gradients of their own, which are added up.
void weight_grad_on_threads(const Device& cpu, const LinearWeightGradArgs& all) {
  const size_t size = size_t(all.in) * all.out, grain = size_t(all.panels) / LinearWork::kChunks;
  AlignedVector<float> d_w(size * LinearWork::kChunks), d_bias(size_t(all.out) * LinearWork::kChunks);
  parallel_for(LinearWork::kChunks, [&](int chunk) {
    LinearWeightGradArgs a = all;
    a.panels = int(grain);
    a.x += size_t(chunk) * grain * a.x_stride * kPanel;
    a.d_y += size_t(chunk) * grain * a.y_stride * kPanel;
    a.d_weights = d_w.data() + size * size_t(chunk);
    a.d_bias = d_bias.data() + size_t(all.out) * size_t(chunk);
    cpu.linear_weight_grad(a);
  });
  for (size_t i = 0; i < d_w.size(); ++i) all.d_weights[i % size] += d_w[i];
  for (size_t i = 0; i < d_bias.size(); ++i) all.d_bias[i % all.out] += d_bias[i];
}

void measure_linear(Report& report, int in, int out) {
  LinearWork l{in, out};
  const Device& cpu = report.cpu();
  const double flops = 2e-12 * kSamples * in * out;
  const std::string size = "linear " + std::to_string(in) + " to " + std::to_string(out);
  report.measure({size + ", weight gradient", "TFLOP/s", flops,
                  [&] { enqueue_linear_weight_grad(l.weights(true)); },
                  [&] { weight_grad_on_threads(cpu, l.weights(false)); }, &l.d_w, kFma, flops});
  report.measure({size + ", forward", "TFLOP/s", flops, [&] { enqueue_linear(l.forward(true)); },
                  [&] { linear_on_threads(cpu, l.forward(false)); }, &l.y, kFma, flops});
  report.measure({size + ", input gradient", "TFLOP/s", flops, [&] { enqueue_linear(l.backward(true)); },
                  [&] { linear_on_threads(cpu, l.backward(false)); }, &l.x, kFma, flops});
}

// The hash grid of the distance field of the presets: engine/reconstruct/presets.cpp, model/field/field.cpp.
struct GridWork {
  static constexpr int kLevels = 14, kRows = 2 * kLevels;
  int log2_table, columns;
  Twin points = noise(size_t(kSamples) * 3, 5), table = noise(size_t(2 * kLevels) << log2_table, 6),
       d_table = Twin(size_t(2 * kLevels) << log2_table),
       out = Twin(size_t(kSamples) * size_t(columns) * kRows, 0.1f);

  GridLevel level(int l) const {
    const double resolution = std::floor(16 * std::pow(384.0 / 16, double(l) / (kLevels - 1)) + 1e-6);
    const bool dense = std::pow(resolution + 1, 3) <= double(1u << log2_table);
    return {float(resolution), uint32_t(resolution) + 1, dense ? 0u : (1u << log2_table) - 1};
  }
  size_t at(int l) const { return size_t(2 * l) << log2_table; }
  EncodeGrid::Args forward(int l, bool card, int begin = 0) {
    const auto of = [card](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    return {{of(points) + size_t(begin) * 3, of(out) + size_t(begin) * size_t(columns) * kRows, kRows, 2 * l,
             columns},
            level(l),
            of(table) + at(l)};
  }
  EncodeGridGrad::Args gradient(int l, bool card) {
    const auto of = [card](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    return {{of(points), of(out), kRows, 2 * l, columns}, level(l), of(d_table) + at(l)};
  }
};

void grid_on_threads(const Device& cpu, GridWork& g) {
  parallel_ranges(kSamples, 2048, [&](int begin, int end) {
    for (int l = 0; l < g.kLevels; ++l) cpu.launch<EncodeGrid>(g.forward(l, false, begin), end - begin);
  });
}

void measure_grid(Report& report, int log2_table, int columns) {
  GridWork g{log2_table, columns};
  const Device& cpu = report.cpu();
  const std::string kind = columns == 1 ? "values" : "jets";
  const double points = 1e-6 * kSamples, pairs = 8e-9 * g.kLevels * kSamples;
  const auto forward = [&] {
    for (int l = 0; l < g.kLevels; ++l) enqueue<EncodeGrid>(g.forward(l, true), kSamples);
  };
  const auto gradient = [&] {
    for (int l = 0; l < g.kLevels; ++l) enqueue<EncodeGridGrad>(g.gradient(l, true), kSamples);
  };
  // Levels share no table, so they are what threads share out.
  const auto gradient_on_threads = [&] {
    parallel_for(g.kLevels, [&](int l) { cpu.launch<EncodeGridGrad>(g.gradient(l, false), kSamples); });
  };
  report.measure({sized(("grid gradient, " + kind).c_str(), log2_table), "M points/s", points, gradient,
                  gradient_on_threads, &g.d_table, sized("add", log2_table), pairs});
  report.measure({sized(("grid, " + kind).c_str(), log2_table), "M points/s", points, forward,
                  [&] { grid_on_threads(cpu, g); }, &g.out, sized("gather", log2_table), pairs});
}

// A frame of 512 x 512 hits under as many lobes as a light has (model/light/fit.h): two reflections of the
// sky, as engine/render/lighting.cpp asks for them, and the shading.
struct FrameWork {
  static constexpr int kHits = 512 * 512, kLobes = 128;
  static Twin directions(int n, uint64_t seed) {  // [3][n]
    return Twin(size_t(3 * n),
                [=](size_t k) { return unit_direction(seed, k % size_t(n))[int(k / size_t(n))]; });
  }
  static Vec3f unit_direction(uint64_t seed, size_t i) {
    Rng rng(seed, 1, i);
    const float x = rng.normal(), y = rng.normal(), z = rng.normal();
    return normalize(Vec3f{x, y, z});
  }
  Twin lobes{size_t(7 * kLobes), [](size_t k) {  // axis, sharpness, color
               const size_t row = k / kLobes;
               return row < 3    ? unit_direction(7, k % kLobes)[int(row)]
                      : row == 3 ? 64 * (0.2f + unit_noise(8, k))
                                 : unit_noise(9, k);
             }};
  Twin axes = directions(kHits, 10), normals = directions(kHits, 11);
  Twin across{size_t(3 * kHits), [](size_t k) {
                const Vec3f side = normalize(cross(unit_direction(10, k % kHits), Vec3f{0.3f, 0.5f, 0.8f}));
                return side[int(k / kHits)];
              }};
  Twin roughness{size_t(kHits), [](size_t i) { return 0.2f + 0.7f * unit_noise(12, i); }},
      stretch{size_t(kHits), [](size_t i) { return 1 + 1.5f * unit_noise(13, i); }},
      points{size_t(ShadingRows::kRows) * kHits, [](size_t i) { return 0.01f + 0.98f * unit_noise(14, i); }},
      table{std::tuple_size_v<PairTable>, [](size_t i) { return split_sum_table()[i]; }};
  Twin d_out = noise(size_t(3 * kHits), 15), sky = Twin(size_t(3 * kHits)),
       terms = Twin(size_t(Shade::kOutputs) * kHits), d_points = Twin(size_t(ShadingRows::kRows) * kHits),
       d_frames = Twin(size_t(11 * kHits));

  // `run` is called with the arguments of each kernel for the hits from `begin` on.
  template <class Run>
  void forward(bool card, int begin, const Run& run) {
    const auto of = [=](Twin& t) { return (card ? t.on_card() : t.on_cpu()) + begin; };
    const auto whole = [=](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    const SgReflection::Args reflection{
        {whole(lobes), kLobes, kLobes}, kHits, {of(axes), of(across), of(normals), of(roughness), of(stretch)}, of(sky)};
    run(SgReflection{}, reflection);
    run(SgReflection{}, reflection);
    run(Shade{}, Shade::Args{whole(table), kHits, of(points), of(terms)});
  }
  template <class Run>
  void backward(bool card, int begin, const Run& run) {
    const auto of = [=](Twin& t) { return (card ? t.on_card() : t.on_cpu()) + begin; };
    const auto whole = [=](Twin& t) { return card ? t.on_card() : t.on_cpu(); };
    run(ShadeGrad{}, ShadeGrad::Args{whole(table), kHits, of(points), of(d_out), of(d_out), of(d_points)});
    float* d = of(d_frames);
    const SgReflectionGrad::Args reflection{{whole(lobes), kLobes, kLobes},
                                            kHits,
                                            {of(axes), of(across), of(normals), of(roughness), of(stretch)},
                                            of(d_out),
                                            d,
                                            d + 3 * kHits,
                                            d + 8 * kHits,
                                            d + 6 * kHits,
                                            d + 7 * kHits};
    run(SgReflectionGrad{}, reflection);
    run(SgReflectionGrad{}, reflection);
  }
};

struct OnCard {
  template <class K>
  void operator()(K, const typename K::Args& args) const {
    enqueue<K>(args, FrameWork::kHits);
  }
};
struct OnCpu {
  const Device& device;
  int n;
  template <class K>
  void operator()(K, const typename K::Args& args) const {
    device.launch<K>(args, n);
  }
};
// One kernel of the frame.
template <class K>
struct Only {
  void operator()(K, const typename K::Args& args) const { enqueue<K>(args, FrameWork::kHits); }
  template <class Other>
  void operator()(Other, const typename Other::Args&) const {}
};

void measure_frame(Report& report) {
  FrameWork f;
  const auto on_threads = [&](auto part) {
    parallel_ranges(f.kHits, 1024, [&](int begin, int end) {
      part(begin, OnCpu{report.cpu(), end - begin});
    });
  };
  const auto forward = [&] {
    on_threads([&](int begin, const OnCpu& run) { f.forward(false, begin, run); });
  };
  const auto backward = [&] {
    on_threads([&](int begin, const OnCpu& run) { f.backward(false, begin, run); });
  };
  const double hits = 1e-6 * f.kHits;
  const auto gigabytes = [&](int rows) { return 4e-9 * rows * f.kHits; };
  constexpr int kAlbedo = 3;  // rows that Shade does not read
  report.measure(
      {"frame of 512 x 512", "M hits/s", hits, [&] { f.forward(true, 0, OnCard{}); }, forward, &f.terms});
  report.measure({"Shade alone",
                  "M hits/s",
                  hits,
                  [&] { f.forward(true, 0, Only<Shade>{}); },
                  {},
                  nullptr,
                  kCopy,
                  gigabytes(ShadingRows::kRows - kAlbedo + Shade::kOutputs)});
  report.measure(
      {"two SgReflection alone", "M hits/s", hits, [&] { f.forward(true, 0, Only<SgReflection>{}); }, {}});
  report.measure({"adjoint of the frame", "M hits/s", hits, [&] { f.backward(true, 0, OnCard{}); }, backward,
                  &f.d_frames});
  report.measure({"ShadeGrad alone",
                  "M hits/s",
                  hits,
                  [&] { f.backward(true, 0, Only<ShadeGrad>{}); },
                  {},
                  nullptr,
                  kCopy,
                  gigabytes(2 * ShadingRows::kRows + 6)});
}

int run() {
  if (const std::string reason = reason_for_no_card(); !reason.empty()) {
    std::printf("SKIP: speed of the kernels on a card: not measured (%s)\n", reason.c_str());
    return 77;
  }
  const Device cpu = make_device("cpu");
  Report report(cpu);
  measure_machine(report);
  measure_waiting(report);
  measure_linear(report, 64, 64);
  measure_linear(report, 32, 64);
  for (const int log2_table : {15, 19})
    for (const int columns : {1, 4}) measure_grid(report, log2_table, columns);
  measure_frame(report);
  report.print();
  if (report.agrees()) return 0;
  std::fprintf(stderr, "The card has other results than the CPU: see the differences in the table\n");
  return 1;
}

}  // namespace
}  // namespace cei3d::cuda

int main() {
  try {
    return cei3d::cuda::run();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
