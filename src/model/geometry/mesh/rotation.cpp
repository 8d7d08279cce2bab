// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/rotation.h"

#include <cmath>

namespace cei3d {
namespace {

struct Symmetric4 {
  double a[4][4];
};

// The matrix N for which q^T N q = trace(R^T m), with R the rotation of the quaternion q = (w, x, y, z).
Symmetric4 quaternion_form(const Mat3d& m) {
  const double xx = m.row[0].x, xy = m.row[0].y, xz = m.row[0].z;
  const double yx = m.row[1].x, yy = m.row[1].y, yz = m.row[1].z;
  const double zx = m.row[2].x, zy = m.row[2].y, zz = m.row[2].z;
  return {{{xx + yy + zz, zy - yz, xz - zx, yx - xy},
           {zy - yz, xx - yy - zz, xy + yx, xz + zx},
           {xz - zx, xy + yx, yy - xx - zz, yz + zy},
           {yx - xy, xz + zx, yz + zy, zz - xx - yy}}};
}

// One Jacobi rotation that zeroes a[p][q]; v collects the eigenvectors in its columns.
void jacobi_step(Symmetric4& s, double (&v)[4][4], int p, int q) {
  auto& a = s.a;
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), sn = t * c;
  for (int k = 0; k < 4; ++k) {
    const double kp = a[k][p], kq = a[k][q];
    a[k][p] = c * kp - sn * kq, a[k][q] = sn * kp + c * kq;
  }
  for (int k = 0; k < 4; ++k) {
    const double pk = a[p][k], qk = a[q][k];
    a[p][k] = c * pk - sn * qk, a[q][k] = sn * pk + c * qk;
    const double kp = v[k][p], kq = v[k][q];
    v[k][p] = c * kp - sn * kq, v[k][q] = sn * kp + c * kq;
  }
}

Mat3d rotation_of(double w, double x, double y, double z) {
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace

Mat3d nearest_rotation(const Mat3d& m) {
  Symmetric4 s = quaternion_form(m);
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  double size = 0;
  for (const auto& row : s.a)
    for (const double x : row) size += x * x;
  for (int sweep = 0; sweep < 12; ++sweep) {
    double off = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) off += s.a[p][q] * s.a[p][q];
    if (off <= 1e-28 * size) break;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) jacobi_step(s, v, p, q);
  }
  int best = 0;
  for (int k = 1; k < 4; ++k)
    if (s.a[k][k] > s.a[best][best]) best = k;
  return rotation_of(v[0][best], v[1][best], v[2][best], v[3][best]);
}

}  // namespace cei3d
