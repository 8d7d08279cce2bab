// SPDX-License-Identifier: Apache-2.0
// W floats in one SIMD register, with the functions of scalar.h. Include only in files that are compiled for
// one instruction set (core/compute/cpu/run.cpp). W must be the native width: GCC compiles wider vectors
// badly.
#pragma once

#include <immintrin.h>

#include "core/math/scalar.h"

namespace cei3d {

template <int W>
struct Reg;  // specialized below: GCC silently drops vector_size when it depends on a template argument
template <>
struct Reg<8> {
  typedef float f __attribute__((vector_size(32)));
  typedef int32_t i __attribute__((vector_size(32)));
  typedef uint32_t u __attribute__((vector_size(32)));
};
template <>
struct Reg<16> {
  typedef float f __attribute__((vector_size(64)));
  typedef int32_t i __attribute__((vector_size(64)));
  typedef uint32_t u __attribute__((vector_size(64)));
};

template <int W>
struct LaneMask {
  typename Reg<W>::i v;  // all ones or all zeros in each lane
};

template <int W>
struct LaneIndex {
  typename Reg<W>::u v;
  HD LaneIndex() = default;
  HD LaneIndex(typename Reg<W>::u r) : v(r) {}
  HD explicit LaneIndex(uint32_t s) : v(s - typename Reg<W>::u{}) {}
  HD friend LaneIndex operator+(LaneIndex a, LaneIndex b) { return LaneIndex(a.v + b.v); }
  HD friend LaneIndex operator*(LaneIndex a, LaneIndex b) { return LaneIndex(a.v * b.v); }
  HD friend LaneIndex operator^(LaneIndex a, LaneIndex b) { return LaneIndex(a.v ^ b.v); }
  HD friend LaneIndex operator&(LaneIndex a, LaneIndex b) { return LaneIndex(a.v & b.v); }
};

template <int W>
struct Lanes {
  using F = typename Reg<W>::f;
  F v;
  HD Lanes() = default;
  HD Lanes(F r) : v(r) {}
  HD explicit Lanes(float s) : v(s - F{}) {}
  HD explicit Lanes(double s) : v(float(s) - F{}) {}
  HD explicit Lanes(int s) : v(float(s) - F{}) {}
  HD explicit Lanes(LaneIndex<W> i) : v(__builtin_convertvector(typename Reg<W>::i(i.v), F)) {}

  HD friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  HD friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  HD friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  HD friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  HD friend Lanes operator-(Lanes a) { return -a.v; }
  HD friend Lanes& operator+=(Lanes& a, Lanes b) { return a = a + b; }
  HD friend LaneMask<W> operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
  HD friend LaneMask<W> operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
  HD friend LaneMask<W> operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
  HD friend LaneMask<W> operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
  HD friend LaneMask<W> operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
};

template <int W>
HD LaneMask<W> operator&(LaneMask<W> a, LaneMask<W> b) {
  return {a.v & b.v};
}
template <int W>
HD LaneMask<W> operator|(LaneMask<W> a, LaneMask<W> b) {
  return {a.v | b.v};
}
template <int W>
HD LaneMask<W> operator!(LaneMask<W> a) {
  return {~a.v};
}
template <int W>
HD bool any(LaneMask<W> m) {
  int32_t bits = 0;
  for (int k = 0; k < W; ++k) bits |= m.v[k];
  return bits != 0;
}
template <int W>
HD bool all(LaneMask<W> m) {
  return !any(!m);
}

template <int W>
HD Lanes<W> select(LaneMask<W> c, Lanes<W> a, Lanes<W> b) {
  return c.v ? a.v : b.v;
}
template <int W>
HD LaneIndex<W> select(LaneMask<W> c, LaneIndex<W> a, LaneIndex<W> b) {
  return c.v ? a.v : b.v;
}
template <int W>
HD Lanes<W> min(Lanes<W> a, Lanes<W> b) {
  return a.v < b.v ? a.v : b.v;
}
template <int W>
HD Lanes<W> max(Lanes<W> a, Lanes<W> b) {
  return a.v > b.v ? a.v : b.v;
}
template <int W>
HD Lanes<W> abs(Lanes<W> a) {
  return max(a, -a);
}

HD Lanes<8> sqrt(Lanes<8> a) { return Reg<8>::f(_mm256_sqrt_ps(__m256(a.v))); }
HD Lanes<8> reciprocal(Lanes<8> a) { return Lanes<8>(1.0f) / a; }
HD Lanes<8> floor(Lanes<8> a) { return Reg<8>::f(_mm256_floor_ps(__m256(a.v))); }
// A pair of floats is gathered as one double. The pointer is read by the intrinsic alone, which may alias any
// type, and never as a double by this code.
HD void gather2(const float* p, LaneIndex<8> i, Lanes<8>& a, Lanes<8>& b) {
  const __m256i idx = __m256i(i.v);
  const auto* q = reinterpret_cast<const double*>(p);
  const __m256 lo = _mm256_castpd_ps(_mm256_i32gather_pd(q, _mm256_castsi256_si128(idx), 8));
  const __m256 hi = _mm256_castpd_ps(_mm256_i32gather_pd(q, _mm256_extracti128_si256(idx, 1), 8));
  const __m256 even = _mm256_shuffle_ps(lo, hi, 0x88), odd = _mm256_shuffle_ps(lo, hi, 0xdd);
  a = Reg<8>::f(_mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(even), 0xd8)));
  b = Reg<8>::f(_mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(odd), 0xd8)));
}
#ifdef __AVX512F__
HD Lanes<16> sqrt(Lanes<16> a) { return Reg<16>::f(_mm512_sqrt_ps(__m512(a.v))); }
// Reciprocal with relative error 1e-7, in a third of the time of a division: 14-bit estimate and one Newton
// step.
HD Lanes<16> reciprocal(Lanes<16> a) {
  const Lanes<16> r = Reg<16>::f(_mm512_rcp14_ps(__m512(a.v)));
  return r + r * (Lanes<16>(1.0f) - a * r);
}
HD Lanes<16> floor(Lanes<16> a) {
  return Reg<16>::f(_mm512_roundscale_ps(__m512(a.v), _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
HD void gather2(const float* p, LaneIndex<16> i, Lanes<16>& a, Lanes<16>& b) {
  const __m512i idx = __m512i(i.v);
  const __m512 lo = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_castsi512_si256(idx), p, 8));
  const __m512 hi = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_extracti64x4_epi64(idx, 1), p, 8));
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  const __m512i odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
  a = Reg<16>::f(_mm512_permutex2var_ps(lo, even, hi));
  b = Reg<16>::f(_mm512_permutex2var_ps(lo, odd, hi));
}
#endif

// Truncation to integers of any sign, for range reduction.
template <int W>
HD typename Reg<W>::i truncate(Lanes<W> a) {
  return __builtin_convertvector(a.v, typename Reg<W>::i);
}

// e^x to about 2 ulp: x = n ln 2 + r, |r| <= ln 2 / 2, Taylor polynomial of e^r. Saturates at about 1e-38 and
// 2e38.
template <int W>
HD Lanes<W> exp(Lanes<W> x) {
  using L = Lanes<W>;
  x = min(max(x, L(-87.0f)), L(88.3f));
  const L n = floor(x * L(1.44269504f) + L(0.5f));
  const L r = (x - n * L(0.693359375f)) + n * L(2.12194440e-4f);
  L p = L(1.0f / 5040.0f);
  p = p * r + L(1.0f / 720.0f);
  p = p * r + L(1.0f / 120.0f);
  p = p * r + L(1.0f / 24.0f);
  p = p * r + L(1.0f / 6.0f);
  p = p * r + L(0.5f);
  p = p * r + L(1.0f);
  p = p * r + L(1.0f);
  const typename Reg<W>::i bits = (truncate(n) + 127) << 23;
  return p * L(typename Reg<W>::f(bits));
}

// ln x for x > 0 (denormals count as 1e-38): x = m 2^e, m in [sqrt 1/2, sqrt 2), ln m = 2 artanh((m - 1)/(m +
// 1)).
template <int W>
HD Lanes<W> log(Lanes<W> x) {
  using L = Lanes<W>;
  using I = typename Reg<W>::i;
  const I bits = I(max(x, L(1.17549435e-38f)).v);
  I e = (bits >> 23) - 127;
  L m = typename Reg<W>::f((bits & 0x007fffff) | 0x3f800000);
  const LaneMask<W> big = m > L(1.41421356f);
  m = select(big, m * L(0.5f), m);
  e = e - big.v;  // the mask is -1 where true
  const L s = (m - L(1.0f)) / (m + L(1.0f)), s2 = s * s;
  L p = L(2.0f / 9.0f);
  p = p * s2 + L(2.0f / 7.0f);
  p = p * s2 + L(2.0f / 5.0f);
  p = p * s2 + L(2.0f / 3.0f);
  p = p * s2 + L(2.0f);
  return L(__builtin_convertvector(e, typename Reg<W>::f)) * L(0.69314718f) + s * p;
}

// ln(1 + x) for x in [0, 1]: 2 artanh(x / (2 + x)), relative error 1e-7.
template <int W>
HD Lanes<W> log1p(Lanes<W> x) {
  using L = Lanes<W>;
  const L s = x * reciprocal(L(2.0f) + x), s2 = s * s;
  L p = L(2.0f / 13.0f);
  p = p * s2 + L(2.0f / 11.0f);
  p = p * s2 + L(2.0f / 9.0f);
  p = p * s2 + L(2.0f / 7.0f);
  p = p * s2 + L(2.0f / 5.0f);
  p = p * s2 + L(2.0f / 3.0f);
  p = p * s2 + L(2.0f);
  return s * p;
}

// sin and cos for |x| up to a few thousand: reduction by pi/2 in three parts, then Taylor polynomials.
template <int W>
HD void sin_cos(Lanes<W> x, Lanes<W>& s, Lanes<W>& c) {
  using L = Lanes<W>;
  using I = typename Reg<W>::i;
  const L q = floor(x * L(0.636619772f) + L(0.5f));
  const L r = ((x - q * L(1.5703125f)) - q * L(4.83751297e-4f)) - q * L(7.5495e-8f);
  const L r2 = r * r;
  const L sr =
      r + r * r2 * (L(-1.0f / 6) + r2 * (L(1.0f / 120) + r2 * (L(-1.0f / 5040) + r2 * L(1.0f / 362880))));
  const L cr = L(1.0f) + r2 * (L(-0.5f) + r2 * (L(1.0f / 24) + r2 * (L(-1.0f / 720) + r2 * L(1.0f / 40320))));
  const I n = truncate(q);
  const LaneMask<W> swap{(n & 1) != 0}, neg_s{(n & 2) != 0}, neg_c{((n + 1) & 2) != 0};
  s = select(swap, cr, sr);
  c = select(swap, sr, cr);
  s = select(neg_s, -s, s);
  c = select(neg_c, -c, c);
}
template <int W>
HD Lanes<W> sin(Lanes<W> x) {
  Lanes<W> s, c;
  sin_cos(x, s, c);
  return s;
}
template <int W>
HD Lanes<W> cos(Lanes<W> x) {
  Lanes<W> s, c;
  sin_cos(x, s, c);
  return c;
}

template <int W>
struct IndexOf<Lanes<W>> {
  using type = LaneIndex<W>;
};
template <int W>
HD LaneIndex<W> to_index_lanes(Lanes<W> a) {
  return LaneIndex<W>(typename Reg<W>::u(truncate(a)));
}
template <>
HD LaneIndex<8> to_index<Lanes<8>>(Lanes<8> a) {
  return to_index_lanes(a);
}
template <>
HD LaneIndex<16> to_index<Lanes<16>>(Lanes<16> a) {
  return to_index_lanes(a);
}

HD float sum_lanes(Lanes<8> a) {
  const __m256 v = __m256(a.v);
  __m128 s = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  s = _mm_add_ps(s, _mm_movehl_ps(s, s));
  return _mm_cvtss_f32(_mm_add_ss(s, _mm_shuffle_ps(s, s, 1)));
}
#ifdef __AVX512F__
HD float sum_lanes(Lanes<16> a) {
  const __m512 v = __m512(a.v);
  return sum_lanes(
      Lanes<8>(Reg<8>::f(_mm256_add_ps(_mm512_castps512_ps256(v), _mm512_extractf32x8_ps(v, 1)))));
}
#endif

// p[k] += sum_lanes(a[k]), the same bits, for four at once.
HD void add_sums4(float* p, __m128 a, __m128 b, __m128 c, __m128 d) {
  const __m128 ab = _mm_add_ps(_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b)),
               cd = _mm_add_ps(_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
  _mm_storeu_ps(p, _mm_add_ps(_mm_loadu_ps(p), _mm_add_ps(_mm_movelh_ps(ab, cd), _mm_movehl_ps(cd, ab))));
}
HD __m128 sum_halves(Lanes<8> a) {
  const __m256 v = __m256(a.v);
  return _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
}
#ifdef __AVX512F__
HD __m128 sum_halves(Lanes<16> a) {
  const __m512 v = __m512(a.v);
  return sum_halves(
      Lanes<8>(Reg<8>::f(_mm256_add_ps(_mm512_castps512_ps256(v), _mm512_extractf32x8_ps(v, 1)))));
}
#endif
template <int W>
HD void add_sums4(float* p, const Lanes<W> a[4]) {
  add_sums4(p, sum_halves(a[0]), sum_halves(a[1]), sum_halves(a[2]), sum_halves(a[3]));
}

#ifdef __AVX512F__
HD void add_sums4(float* p, const Lanes<16> a[4]) {  // the quarters of all four at once
  const __m512 v0 = __m512(a[0].v), v1 = __m512(a[1].v), v2 = __m512(a[2].v), v3 = __m512(a[3].v);
  const __m512d ab = _mm512_castps_pd(_mm512_add_ps(_mm512_unpacklo_ps(v0, v1), _mm512_unpackhi_ps(v0, v1))),
                cd = _mm512_castps_pd(_mm512_add_ps(_mm512_unpacklo_ps(v2, v3), _mm512_unpackhi_ps(v2, v3)));
  const Lanes<16> quarters(Reg<16>::f(_mm512_add_ps(_mm512_castpd_ps(_mm512_unpacklo_pd(ab, cd)),
                                                    _mm512_castpd_ps(_mm512_unpackhi_pd(ab, cd)))));
  _mm_storeu_ps(p, _mm_add_ps(_mm_loadu_ps(p), sum_halves(quarters)));
}
#endif

template <class L>
struct LanesMemory {
  using F = typename L::F;
  HD static L load(const float* p) {
    F r;
    __builtin_memcpy(&r, p, sizeof r);
    return r;
  }
  HD static void store(float* p, L v) { __builtin_memcpy(p, &v.v, sizeof v.v); }
};
template <>
HD Lanes<8> load<Lanes<8>>(const float* p) {
  return LanesMemory<Lanes<8>>::load(p);
}
template <>
HD Lanes<16> load<Lanes<16>>(const float* p) {
  return LanesMemory<Lanes<16>>::load(p);
}
template <>
HD void store<Lanes<8>>(float* p, Lanes<8> v) {
  LanesMemory<Lanes<8>>::store(p, v);
}
template <>
HD void store<Lanes<16>>(float* p, Lanes<16> v) {
  LanesMemory<Lanes<16>>::store(p, v);
}

// Adds (a, b) to the pair at p[2 i], lane after lane.
template <int W>
HD void scatter_add2(float* p, LaneIndex<W> i, Lanes<W> a, Lanes<W> b) {
  for (int k = 0; k < W; ++k) {
    float* q = p + 2 * size_t(i.v[k]);
    q[0] += a.v[k];
    q[1] += b.v[k];
  }
}
template <int W>
HD Lanes<W> gather_lanes(const float* p, LaneIndex<W> i) {
  Lanes<W> r;
  for (int k = 0; k < W; ++k) r.v[k] = p[i.v[k]];
  return r;
}
template <>
HD Lanes<8> gather<Lanes<8>>(const float* p, uint32_t i) {
  return Lanes<8>(p[i]);
}
template <>
HD Lanes<16> gather<Lanes<16>>(const float* p, uint32_t i) {
  return Lanes<16>(p[i]);
}
template <int W>
HD Lanes<W> gather(const float* p, LaneIndex<W> i) {
  return gather_lanes(p, i);
}

}  // namespace cei3d
