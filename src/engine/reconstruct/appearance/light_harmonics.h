// SPDX-License-Identifier: Apache-2.0
// Light in real spherical harmonics up to the third band: what matte surfaces see of it.
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

// Between the cells of a lat-long light (EnvUp::z) and harmonics.
class LightHarmonics {
 public:
  explicit LightHarmonics(int height);
  HarmonicLight of(const std::vector<Vec3f>& light) const;                   // #cells
  void add_transposed(const HarmonicLight&, std::vector<Vec3f>& sum) const;  // the adjoint of `of`

 private:
  std::vector<Harmonics> cells_;  // times their solid angles
};

// The matrix that turns harmonics: harmonics(rotation * d) = matrix * harmonics(d). Row by row.
using HarmonicMatrix = std::array<Harmonics, kHarmonics>;
HarmonicMatrix turned_harmonics(const Mat3f& rotation);
Harmonics operator*(const HarmonicMatrix&, const Harmonics&);

}  // namespace cei3d
