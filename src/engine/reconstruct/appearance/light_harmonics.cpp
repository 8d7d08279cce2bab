// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_harmonics.h"

#include <cmath>

#include "model/light/envmap.h"

namespace cei3d {

LightHarmonics::LightHarmonics(int height) {
  const int width = 2 * height;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      Harmonics h = harmonics(env_direction(float(column) + 0.5f, float(row) + 0.5f, width, height));
      for (float& v : h) v *= env_solid_angle(row, width, height);
      cells_.push_back(h);
    }
}

HarmonicLight LightHarmonics::of(const std::vector<Vec3f>& light) const {
  HarmonicLight sum{};
  for (size_t i = 0; i < light.size(); ++i)
    for (size_t j = 0; j < kHarmonics; ++j) sum[j] += light[i] * cells_[i][j];
  return sum;
}

void LightHarmonics::add_transposed(const HarmonicLight& h, std::vector<Vec3f>& sum) const {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += dot(cells_[i], h);
}

// By quadrature: products of two such harmonics are of the sixth band, which this many points integrate.
HarmonicMatrix turned_harmonics(const Mat3f& rotation) {
  constexpr int kRows = 24;
  HarmonicMatrix m{};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < 2 * kRows; ++column) {
      const Vec3f d = env_direction(float(column) + 0.5f, float(row) + 0.5f, 2 * kRows, kRows);
      const Harmonics from = harmonics(d), to = harmonics(rotation * d);
      const float area = env_solid_angle(row, 2 * kRows, kRows);
      for (size_t i = 0; i < kHarmonics; ++i)
        for (size_t j = 0; j < kHarmonics; ++j) m[i][j] += to[i] * from[j] * area;
    }
  return m;
}

Harmonics operator*(const HarmonicMatrix& m, const Harmonics& h) {
  Harmonics out{};
  for (size_t i = 0; i < kHarmonics; ++i)
    for (size_t j = 0; j < kHarmonics; ++j) out[i] += m[i][j] * h[j];
  return out;
}

}  // namespace cei3d
