// SPDX-License-Identifier: Apache-2.0
// Small vectors and 3x3 matrices over any number type.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

template <class T>
struct Vec2 {
  T x, y;
};

template <class T>
struct Vec3 {
  T x, y, z;
  HD T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  HD const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};
using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
HD Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
HD Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
HD Vec3<T> operator-(Vec3<T> a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
HD Vec3<T> operator*(Vec3<T> a, Vec3<T> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
HD Vec3<T> operator/(Vec3<T> a, Vec3<T> b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}
template <class T>
HD Vec3<T> operator*(Vec3<T> a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
HD Vec3<T> operator*(T s, Vec3<T> a) {
  return a * s;
}
template <class T>
HD Vec3<T> operator/(Vec3<T> a, T s) {
  return a * (T(1) / s);
}
template <class T>
HD Vec3<T>& operator+=(Vec3<T>& a, Vec3<T> b) {
  return a = a + b;
}
template <class T>
HD T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
HD Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
HD T length(Vec3<T> a) {
  return sqrt(dot(a, a));
}
// Unit vector. The zero vector stays nearly zero instead of becoming NaN.
template <class T>
HD Vec3<T> normalize(Vec3<T> a) {
  return a * (T(1) / sqrt(dot(a, a) + T(1e-20f)));
}

// Row-major 3x3 matrix.
template <class T>
struct Mat3 {
  Vec3<T> row[3];
  HD static Mat3 identity() { return {{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}}; }
};
using Mat3f = Mat3<float>;
using Mat3d = Mat3<double>;

template <class T>
HD Vec3<T> operator*(const Mat3<T>& m, Vec3<T> v) {
  return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}
template <class T>
HD Mat3<T> transpose(const Mat3<T>& m) {
  return {{{m.row[0].x, m.row[1].x, m.row[2].x},
           {m.row[0].y, m.row[1].y, m.row[2].y},
           {m.row[0].z, m.row[1].z, m.row[2].z}}};
}
template <class T>
HD Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) {
  const Mat3<T> bt = transpose(b);
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    c.row[i] = {dot(a.row[i], bt.row[0]), dot(a.row[i], bt.row[1]), dot(a.row[i], bt.row[2])};
  return c;
}
template <class T>
HD T determinant(const Mat3<T>& m) {
  return dot(m.row[0], cross(m.row[1], m.row[2]));
}
// Inverse transpose, by which normals transform when points transform by m. m: not singular.
template <class T>
HD Mat3<T> inverse_transpose(const Mat3<T>& m) {
  const T s = T(1) / determinant(m);
  return {{cross(m.row[1], m.row[2]) * s, cross(m.row[2], m.row[0]) * s, cross(m.row[0], m.row[1]) * s}};
}
template <class T>
HD Mat3<T> inverse(const Mat3<T>& m) {
  return transpose(inverse_transpose(m));
}

inline Vec3f to_float(Vec3d v) { return {float(v.x), float(v.y), float(v.z)}; }
inline Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }

}  // namespace cei3d
