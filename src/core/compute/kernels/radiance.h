// SPDX-License-Identifier: Apache-2.0
// The inputs of the auxiliary radiance network at a surface sample: SDF features, normal n, position,
// direction of the ray (away from the camera), n . v with v the direction to the camera, and the mirrored
// direction with four octaves. Where the light turns against the object, the normal is in the frame of the
// light, in which it tells the irradiance. All else is the object's: what a hollow reflects is mostly the
// object itself.
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/panel.h"
#include "core/math/encoding.h"

namespace cei3d {

inline constexpr int kRadianceOctaves = 4;
HD constexpr int radiance_rows(int features) { return features + 3 + 3 + 3 + 1 + 3 + 6 * kRadianceOctaves; }

// Rotation of sample i. rotations: [panels][9][32], row-major.
template <class T>
HD Mat3<T> load_rotation(const float* rotations, int i) {
  const float* p = rotations + panel_at(i, 1, 0, 9, 0);
  const auto row = [&](int r) {
    const float* q = p + 3 * r * kPanel;
    return Vec3<T>{load<T>(q), load<T>(q + kPanel), load<T>(q + 2 * kPanel)};
  };
  return {{row(0), row(1), row(2)}};
}
HD void store_rotation(float* rotations, int i, const Mat3f& r) {  // [panels][9][32]
  for (int k = 0; k < 9; ++k) rotations[panel_at(i, 1, 0, 9, k)] = r.row[k / 3][k % 3];
}
// rotations: null for none.
template <class T>
HD Vec3<T> rotated(const float* rotations, int i, Vec3<T> v) {
  return rotations ? load_rotation<T>(rotations, i) * v : v;
}
template <class T>
HD Vec3<T> rotated_back(const float* rotations, int i, Vec3<T> v) {
  return rotations ? transpose(load_rotation<T>(rotations, i)) * v : v;
}

struct RadianceInput {
  struct Args {
    const float* points;      // [panels][3][32]
    const float* directions;  // [panels][3][32], unit, away from the camera
    const float* jets;        // [panels * 4][1 + features][32]
    float* input;             // [panels][radiance_rows][32], written
    int features;
    const float* rotations = nullptr;  // room_from_object of the light, as for rotated()
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int rows = radiance_rows(a.features);
    float* out = a.input + panel_at(i, 1, 0, rows, 0);
    const auto put = [&](T v) {
      store<T>(out, v);
      out += kPanel;
    };
    for (int f = 0; f < a.features; ++f) put(load<T>(a.jets + panel_at(i, 4, 0, 1 + a.features, 1 + f)));
    const Vec3<T> n = normalize(load_sdf_gradient<T>(a.jets, i, 1 + a.features));
    const Vec3<T> normal_in_room = rotated(a.rotations, i, n);
    const Vec3<T> x = load_point<T>(a.points, i), d = load_point<T>(a.directions, i);
    const Vec3<T> v = -d, r = mirrored(n, v);
    const T nv = dot(n, v);
    for (int k = 0; k < 3; ++k) put(normal_in_room[k]);
    for (int k = 0; k < 3; ++k) put(x[k]);
    for (int k = 0; k < 3; ++k) put(d[k]);
    put(nv);
    for (int k = 0; k < 3; ++k) put(r[k]);
    for (int o = 0; o < kRadianceOctaves; ++o)
      for (int k = 0; k < 3; ++k) {
        T value[2], by_r[2];
        frequency_eval(r[k], o, value, by_r);
        put(value[0]);
        put(value[1]);
      }
  }
};

// Adjoint of RadianceInput with respect to the jets: adds to rows 1.. of the value column (features) and to
// the derivative columns of row 0 (normal).
struct RadianceInputGrad {
  struct Args {
    const float* directions;  // [panels][3][32], as in the forward pass
    const float* jets;        // [panels * 4][1 + features][32], as in the forward pass
    const float* d_input;     // [panels][radiance_rows][32]
    float* d_jets;            // like jets, added to
    int features;
    const float* rotations = nullptr;  // as in the forward pass
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int rows = radiance_rows(a.features), sdf_rows = 1 + a.features;
    const float* in = a.d_input + panel_at(i, 1, 0, rows, 0);
    const auto get = [&](int row) { return load<T>(in + size_t(row) * kPanel); };
    const auto get3 = [&](int row) { return Vec3<T>{get(row), get(row + 1), get(row + 2)}; };
    for (int f = 0; f < a.features; ++f) {
      float* d = a.d_jets + panel_at(i, 4, 0, sdf_rows, 1 + f);
      store<T>(d, load<T>(d) + get(f));
    }
    const Vec3<T> g = load_sdf_gradient<T>(a.jets, i, sdf_rows);
    const Vec3<T> d = load_point<T>(a.directions, i);
    const T inverse = T(1.0f) / sqrt(dot(g, g) + T(1e-20f));
    const Vec3<T> n = g * inverse, v = -d;
    const T nv = dot(n, v);
    const Vec3<T> r = mirrored(n, v);
    const int at_r = a.features + 10;
    Vec3<T> d_r = get3(at_r);
    for (int o = 0; o < kRadianceOctaves; ++o)
      for (int k = 0; k < 3; ++k) {
        T value[2], by_r[2];
        frequency_eval(r[k], o, value, by_r);
        const int row = at_r + 3 + 6 * o + 2 * k;
        d_r[k] = d_r[k] + by_r[0] * get(row) + by_r[1] * get(row + 1);
      }
    const Vec3<T> d_n = rotated_back(a.rotations, i, get3(a.features)) + v * get(a.features + 9) +
                        (d_r * nv + v * dot(d_r, n)) * T(2.0f);
    const Vec3<T> d_g = (d_n - n * dot(n, d_n)) * inverse;
    for (int k = 0; k < 3; ++k) {
      float* p = a.d_jets + panel_at(i, 4, 1 + k, sdf_rows, 0);
      store<T>(p, load<T>(p) + d_g[k]);
    }
  }
};

}  // namespace cei3d
