// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a value is a function of (seed, step, item), so a resumed run draws the same
// numbers as an uninterrupted one.
#pragma once

#include <cstdint>

#include "core/math/scalar.h"

namespace cei3d {

// Finalizer of splitmix64: a bijection that scatters neighboring keys.
HD uint64_t mix_bits(uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

class Rng {
 public:
  HD Rng(uint64_t seed, uint64_t step, uint64_t item)
      : state_(mix_bits(mix_bits(mix_bits(seed) ^ step) ^ item)) {}
  HD uint32_t bits() {
    state_ += 0x9e3779b97f4a7c15ull;
    return uint32_t(mix_bits(state_) >> 32);
  }
  HD float uniform() { return float(bits() >> 8) * (1.0f / 16777216.0f); }          // [0, 1)
  HD uint32_t below(uint32_t n) { return uint32_t((uint64_t(bits()) * n) >> 32); }  // [0, n)
  HD float normal() {                                                               // N(0, 1), Box-Muller
    const float u = 1.0f - uniform(), v = uniform();
    return sqrt(-2.0f * log(u)) * cos(2.0f * kPi * v);
  }

 private:
  uint64_t state_;
};

}  // namespace cei3d
