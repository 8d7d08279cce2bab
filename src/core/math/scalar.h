// SPDX-License-Identifier: Apache-2.0
// The functions that equations are written in. A number type T is float, double, Lanes<W> (core/math/lanes.h)
// or Dual<...> (core/math/dual.h). Equations use only + - * / and the functions below, never `if` on a value.
#pragma once

#include <cmath>
#include <cstdint>

// For functions of host and device. nvcc's attributes are not C++, hence a macro; it has no prefix because it
// stands before hundreds of formulas, and no header of this program is installed.
#ifdef __CUDACC__
#define HD __host__ __device__ __forceinline__
#else
#define HD inline __attribute__((always_inline))  // so that no instruction set leaks through a weak symbol
#endif

namespace cei3d {

HD float select(bool c, float a, float b) { return c ? a : b; }
HD double select(bool c, double a, double b) { return c ? a : b; }
HD uint32_t select(bool c, uint32_t a, uint32_t b) { return c ? a : b; }
HD bool any(bool c) { return c; }
HD bool all(bool c) { return c; }
HD float min(float a, float b) { return a < b ? a : b; }
HD double min(double a, double b) { return a < b ? a : b; }
HD float max(float a, float b) { return a > b ? a : b; }
HD double max(double a, double b) { return a > b ? a : b; }
HD int min(int a, int b) { return a < b ? a : b; }
HD int max(int a, int b) { return a > b ? a : b; }
HD float abs(float a) { return ::fabsf(a); }
HD double abs(double a) { return ::fabs(a); }
HD float sqrt(float a) { return ::sqrtf(a); }
HD double sqrt(double a) { return ::sqrt(a); }
HD float reciprocal(float a) { return 1 / a; }
HD double reciprocal(double a) { return 1 / a; }
HD float exp(float a) { return ::expf(a); }
HD double exp(double a) { return ::exp(a); }
HD float log(float a) { return ::logf(a); }
HD double log(double a) { return ::log(a); }
HD float log1p(float a) { return ::log1pf(a); }
HD double log1p(double a) { return ::log1p(a); }
HD float sin(float a) { return ::sinf(a); }
HD double sin(double a) { return ::sin(a); }
HD float cos(float a) { return ::cosf(a); }
HD double cos(double a) { return ::cos(a); }
template <class T>
HD void sin_cos(T x, T& s, T& c) {
  s = sin(x);
  c = cos(x);
}
// For a constant exponent; not for Lanes.
HD float pow(float a, float exponent) { return ::powf(a, exponent); }
HD double pow(double a, float exponent) { return ::pow(a, double(exponent)); }
HD float floor(float a) { return ::floorf(a); }
HD double floor(double a) { return ::floor(a); }

// The value of any number type as a double, for tests and for control flow outside kernels.
HD double value_of(float a) { return a; }
HD double value_of(double a) { return a; }

// The unsigned integer type that belongs to T (array indices).
template <class T>
struct IndexOf {
  using type = uint32_t;
};
template <class T>
using Index = typename IndexOf<T>::type;

template <class T>
HD Index<T> to_index(T a) {  // a >= 0
  return Index<T>(value_of(a));
}
template <>
HD uint32_t to_index<float>(float a) {  // without double precision, which is slow on a GPU
  return uint32_t(a);
}

// Loads and stores. Item i is one sample for a scalar T and the first of W consecutive samples for Lanes<W>.
template <class T>
HD T load(const float* p) {
  return T(*p);
}
template <class T>
HD void store(float* p, T v) {
  *p = float(value_of(v));
}
template <class T>
HD T gather(const float* p, uint32_t i) {
  return T(p[i]);
}
// Two neighboring floats p[2 i], p[2 i + 1]; on a GPU, which loads both at once, p is aligned to 8 bytes.
template <class T>
HD void gather2(const float* p, uint32_t i, T& a, T& b) {
#ifdef __CUDA_ARCH__
  const float2 pair = reinterpret_cast<const float2*>(p)[i];
  a = T(pair.x);
  b = T(pair.y);
#else
  a = T(p[2 * i]);
  b = T(p[2 * i + 1]);
#endif
}
// Adds (a, b) to the pair p[2 i], p[2 i + 1]; on a GPU other threads may add to it at the same time.
HD void scatter_add2(float* p, uint32_t i, float a, float b) {
#ifdef __CUDA_ARCH__
  atomicAdd(p + 2 * i, a);
  atomicAdd(p + 2 * i + 1, b);
#else
  p[2 * i] += a;
  p[2 * i + 1] += b;
#endif
}

template <class T>
HD T square(T a) {
  return a * a;
}
template <class T>
HD T clamp(T a, T lo, T hi) {
  return min(max(a, lo), hi);
}

inline constexpr float kPi = 3.14159265358979323846f;

}  // namespace cei3d
