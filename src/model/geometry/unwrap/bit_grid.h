// SPDX-License-Identifier: Apache-2.0
// Sets of cells, which packing of charts shifts and compares by whole words.
#pragma once

#include <cstdint>
#include <vector>

namespace cei3d {

// A grid of bits in rows of 64-bit words.
class BitGrid {
 public:
  BitGrid() = default;
  BitGrid(int width, int height)
      : width_(width), height_(height), words_((width + 63) / 64), bits_(size_t(words_) * height, 0) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int words() const { return words_; }
  uint64_t* row(int y) { return &bits_[size_t(y) * words_]; }
  const uint64_t* row(int y) const { return &bits_[size_t(y) * words_]; }
  bool at(int x, int y) const { return row(y)[x / 64] >> (x % 64) & 1; }
  void set(int x, int y) { row(y)[x / 64] |= uint64_t(1) << (x % 64); }

 private:
  int width_ = 0, height_ = 0, words_ = 0;
  std::vector<uint64_t> bits_;
};

// out |= in shifted down by n bits: bit x of `in` goes to x - n.
inline void or_shifted_down(uint64_t* out, const uint64_t* in, int words, int n) {
  const int skip = n / 64, bits = n % 64;
  for (int w = 0; w + skip < words; ++w) {
    uint64_t v = in[w + skip] >> bits;
    if (bits > 0 && w + skip + 1 < words) v |= in[w + skip + 1] << (64 - bits);
    out[w] |= v;
  }
}

}  // namespace cei3d
