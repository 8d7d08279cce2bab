// SPDX-License-Identifier: Apache-2.0
// Forward-mode automatic differentiation, for tests: a number and its derivative along one direction.
// Dual<double> gives first derivatives to machine precision, Dual<Dual<double>> second ones. Has the
// functions of scalar.h; comparisons use the value only, so at a kink the derivative is that of the branch
// taken.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

template <class T>
struct Dual {
  T value{}, derivative{};
  Dual() = default;
  explicit Dual(float v) : value(v), derivative(0.0f) {}
  explicit Dual(double v) : value(T(v)), derivative(0.0f) {}
  explicit Dual(int v) : value(T(v)), derivative(0.0f) {}
  explicit Dual(uint32_t v) : value(T(double(v))), derivative(0.0f) {}
  Dual(T v, T d) : value(v), derivative(d) {}

  friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.derivative + b.derivative}; }
  friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.derivative - b.derivative}; }
  friend Dual operator-(Dual a) { return {-a.value, -a.derivative}; }
  friend Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
  }
  friend Dual operator/(Dual a, Dual b) {
    const T q = a.value / b.value;
    return {q, (a.derivative - q * b.derivative) / b.value};
  }
  friend Dual& operator+=(Dual& a, Dual b) { return a = a + b; }
  friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
  friend bool operator<=(Dual a, Dual b) { return a.value <= b.value; }
  friend bool operator>(Dual a, Dual b) { return a.value > b.value; }
  friend bool operator>=(Dual a, Dual b) { return a.value >= b.value; }
  friend bool operator==(Dual a, Dual b) { return a.value == b.value; }
};

template <class T>
Dual<T> select(bool c, Dual<T> a, Dual<T> b) {
  return c ? a : b;
}
template <class T>
Dual<T> min(Dual<T> a, Dual<T> b) {
  return a < b ? a : b;
}
template <class T>
Dual<T> max(Dual<T> a, Dual<T> b) {
  return a > b ? a : b;
}
template <class T>
Dual<T> abs(Dual<T> a) {
  return value_of(a) < 0 ? -a : a;
}
template <class T>
Dual<T> sqrt(Dual<T> a) {
  const T r = sqrt(a.value);
  return {r, a.derivative / (r + r)};
}
template <class T>
Dual<T> reciprocal(Dual<T> a) {
  const T r = reciprocal(a.value);
  return {r, -a.derivative * r * r};
}
template <class T>
Dual<T> exp(Dual<T> a) {
  const T e = exp(a.value);
  return {e, a.derivative * e};
}
template <class T>
Dual<T> log(Dual<T> a) {
  return {log(a.value), a.derivative / a.value};
}
template <class T>
Dual<T> log1p(Dual<T> a) {
  return {log1p(a.value), a.derivative / (T(1.0f) + a.value)};
}
template <class T>
Dual<T> pow(Dual<T> a, float exponent) {
  return {pow(a.value, exponent), a.derivative * T(exponent) * pow(a.value, exponent - 1)};
}
template <class T>
Dual<T> sin(Dual<T> a) {
  return {sin(a.value), a.derivative * cos(a.value)};
}
template <class T>
Dual<T> cos(Dual<T> a) {
  return {cos(a.value), -(a.derivative * sin(a.value))};
}
template <class T>
Dual<T> floor(Dual<T> a) {
  return {floor(a.value), T(0.0f)};
}
template <class T>
double value_of(Dual<T> a) {
  return value_of(a.value);
}
template <class T>
double derivative_of(Dual<T> a) {
  return value_of(a.derivative);
}

}  // namespace cei3d
