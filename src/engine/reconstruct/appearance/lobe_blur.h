// SPDX-License-Identifier: Apache-2.0
// A lat-long light blurred by the reflection lobe of a roughness.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// A linear map P = K L on the light's own grid of `height` rows and 2 height columns (EnvUp::z). K commutes
// with rotations about the poles, so after a Fourier transform of the rows it is one matrix [height][height]
// per frequency.
class LobeBlur {
 public:
  LobeBlur(float roughness, int height);

  void apply(const std::vector<Vec3f>& light, std::vector<Vec3f>& blurred) const;
  void apply_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const;
  // Applies the transpose of the matrix whose entries are the squares of those of K.
  void apply_squared_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const;

 private:
  std::vector<float> spectrum_of(const std::vector<float>& kernel) const;
  // Fourier coefficients of one row of a light: [6][frequency], real and imaginary parts of red, green, blue.
  using RowSpectrum = std::vector<float>;
  RowSpectrum transformed(std::span<const Vec3f> row) const;
  void transform_back(const RowSpectrum&, std::span<Vec3f> row) const;
  void run(const std::vector<float>& spectrum, bool transposed, const std::vector<Vec3f>& in,
           std::vector<Vec3f>& out) const;

  int height_, width_, frequencies_;
  std::vector<float> cosines_, sines_;   // [frequency][column], for all `width` frequencies: symmetric
  std::vector<float> spectrum_;          // [row out][row in][frequency]; real, because the lobe is symmetric
  std::vector<float> squared_spectrum_;  // of the squared entries
};

}  // namespace cei3d
