// SPDX-License-Identifier: Apache-2.0
// Every kernel for one instruction set. Compiled as scalar, avx2 and avx512 with CEI3D_ISA and CEI3D_WIDTH
// set; no STL here and nothing that could leave a weak symbol outside namespace CEI3D_ISA (tools/check_isa.sh
// looks).
#include "core/compute/device.h"
#include "core/compute/kernels/all.h"
#if CEI3D_WIDTH > 1
#include "core/math/lanes.h"
#endif

namespace cei3d {
#if CEI3D_WIDTH == 1
HD float sum_lanes(float a) { return a; }
HD void add_sums4(float* p, const float a[4]) {
  for (int k = 0; k < 4; ++k) p[k] += a[k];
}
#endif
}  // namespace cei3d
#include "core/compute/cpu/linear.h"
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#define CEI3D_TEXT2(x) #x
#define CEI3D_TEXT(x) CEI3D_TEXT2(x)

namespace cei3d::CEI3D_ISA {
namespace {

#if CEI3D_WIDTH == 1
using Number = float;
#else
using Number = Lanes<CEI3D_WIDTH>;
#endif

// Runs `work` with numbers below 1e-38 counting as zero: denormals cost a hundred cycles each, and lobes far
// from their axis produce many. No destructor: its unwinding would be shared code.
template <class Work>
void flushing_denormals(const Work& work) {
#ifdef __SSE__
  constexpr unsigned kFlushResults = 0x8000, kFlushOperands = 0x0040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlushResults | kFlushOperands);
  work();
  _mm_setcsr(before);
#else
  work();
#endif
}

template <class K>
void launch(const void* p, int n) {
  const auto& args = *static_cast<const typename K::Args*>(p);
  flushing_denormals([&] {
    for (int i = 0; i < n; i += CEI3D_WIDTH) K::template run<Number>(args, i);
  });
}

template <class List>
struct Table;
template <class... K>
struct Table<KernelList<K...>> {
  static constexpr void (*entries[])(const void*, int) = {&launch<K>...};
};

void linear(const LinearArgs& a) {
  flushing_denormals([&] { linear_run<Number, CEI3D_WIDTH>(a); });
}
void linear_weight_grad(const LinearWeightGradArgs& a) {
  flushing_denormals([&] { weight_grad_run<Number, CEI3D_WIDTH>(a); });
}

// Independent multiply-adds in registers: the upper bound for kernels on this instruction set. Returns FLOPs
// done.
double fma_peak() {
  constexpr int kChains = 12, kRounds = 1 << 20;
  Number s[kChains];
  for (int k = 0; k < kChains; ++k) s[k] = Number(float(k));
  for (int i = 0; i < kRounds; ++i)
    for (int k = 0; k < kChains; ++k) s[k] = s[k] * Number(0.999f) + Number(0.5f);
  Number sum(0.0f);
  for (int k = 0; k < kChains; ++k) sum = sum + s[k];
  volatile float sink = sum_lanes(sum);
  (void)sink;
  return 2.0 * kChains * kRounds * CEI3D_WIDTH;
}

// Pseudo-random places of a table of mask + 1 entries, different ones in every lane.
struct RandomPlaces {
  Index<Number> at = Index<Number>(12345u);
  uint32_t mask;
  explicit RandomPlaces(uint32_t mask_in) : mask(mask_in) {
#if CEI3D_WIDTH > 1
    for (int k = 0; k < CEI3D_WIDTH; ++k) at.v[k] = uint32_t(k) * 2654435761u;
#endif
  }
  Index<Number> next() {
    at = at * Index<Number>(1664525u) + Index<Number>(1013904223u);
    return (at ^ (at * Index<Number>(805459861u))) & Index<Number>(mask);
  }
};

constexpr int kPlaces = 1 << 21;  // registers of places that the two peaks visit

// Pairs of floats from pseudo-random places of a table. Returns gathers done.
double gather_peak(const float* pairs, uint32_t mask) {
  RandomPlaces places(mask);
  Number sum(0.0f);
  for (int i = 0; i < kPlaces; ++i) {
    Number a, b;
    gather2(pairs, places.next(), a, b);
    sum = sum + a + b;
  }
  volatile float sink = sum_lanes(sum);
  (void)sink;
  return double(kPlaces) * CEI3D_WIDTH;
}

// Adds to pairs of floats at the same places. Returns pairs done.
double scatter_peak(float* pairs, uint32_t mask) {
  RandomPlaces places(mask);
  for (int i = 0; i < kPlaces; ++i) scatter_add2(pairs, places.next(), Number(1e-6f), Number(-1e-6f));
  return double(kPlaces) * CEI3D_WIDTH;
}

}  // namespace

extern const LaunchTable table;
const LaunchTable table{"cpu/" CEI3D_TEXT(CEI3D_ISA),
                        CEI3D_WIDTH,
                        Table<AllKernels>::entries,
                        linear,
                        linear_weight_grad,
                        fma_peak,
                        gather_peak,
                        scatter_peak};

}  // namespace cei3d::CEI3D_ISA
