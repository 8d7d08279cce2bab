// SPDX-License-Identifier: Apache-2.0
// Well-spread numbers in [0, 1)^2 for the samples of one pixel: for every pair, the first two dimensions of
// Sobol's sequence, shuffled and scrambled. The first 2^k samples of a pair are stratified in every way.
// [Sobol 1967; Burley 2020, "Practical hash-based Owen scrambling"]
#pragma once

#include "core/math/rng.h"
#include "core/math/vec.h"

namespace cei3d {

class SampleSequence {
 public:
  // key: of the pixel, the same for all its samples.
  SampleSequence(uint64_t key, uint32_t sample) : key_(key), sample_(sample) {}

  // The next pair of this sample.
  Vec2<float> pair() {
    key_ = mix_bits(key_);
    const uint32_t order = scrambled(sample_, uint32_t(key_)) & 0xffff;  // at most 65,536 samples
    const uint32_t x = scrambled(reversed(order), uint32_t(key_ >> 16)),
                   y = scrambled(second(order), uint32_t(key_ >> 32));
    return {unit(x), unit(y)};
  }

 private:
  static float unit(uint32_t bits) { return float(bits >> 8) * (1.0f / 16777216.0f); }
  static uint32_t reversed(uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
  }
  // The second dimension of Sobol's sequence.
  static uint32_t second(uint32_t index) {
    uint32_t out = 0;
    for (uint32_t column = 0x80000000u; index; index >>= 1, column ^= column >> 1)
      if (index & 1) out ^= column;
    return out;
  }
  // Owen's scrambling: a bit is flipped or not depending on the bits above it.
  static uint32_t scrambled(uint32_t x, uint32_t seed) {
    x = reversed(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversed(x);
  }

  uint64_t key_;
  uint32_t sample_;
};

}  // namespace cei3d
