// SPDX-License-Identifier: Apache-2.0
// Light in real spherical harmonics up to the third band: the part that diffuse surfaces reflect.
#pragma once

#include <array>
#include <vector>

#include "core/math/harmonics.h"

namespace cei3d {

using HarmonicLight = std::array<Vec3f, kHarmonics>;

inline Vec3f dot(const Harmonics& a, const HarmonicLight& b) {
  Vec3f sum{0, 0, 0};
  for (size_t j = 0; j < kHarmonics; ++j) sum += b[j] * a[j];
  return sum;
}

// Projection of a lat-long light (EnvUp::z) of `height` rows onto harmonics.
class LightHarmonics {
 public:
  explicit LightHarmonics(int height);
  HarmonicLight of(const std::vector<Vec3f>& light) const;                   // light: #cells
  void add_transposed(const HarmonicLight&, std::vector<Vec3f>& sum) const;  // adjoint of of(), added to sum

 private:
  std::vector<Harmonics> cells_;  // times their solid angles
};

// Rows of the matrix that rotates harmonics: harmonics(rotation * d) = matrix * harmonics(d).
using HarmonicMatrix = std::array<Harmonics, kHarmonics>;
HarmonicMatrix turned_harmonics(const Mat3f& rotation);
Harmonics operator*(const HarmonicMatrix&, const Harmonics&);

}  // namespace cei3d
