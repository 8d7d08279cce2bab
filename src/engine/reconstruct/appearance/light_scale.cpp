// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_scale.h"

#include <cmath>

namespace cei3d {
namespace {

Mat3d diagonal(Vec3d d) { return {{{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}}; }

void add(Mat3d& sum, const Mat3d& m, double factor = 1) {
  for (int i = 0; i < 3; ++i) sum.row[i] += m.row[i] * factor;
}

Mat3d outer(Vec3d a, Vec3d b) { return {{b * a.x, b * a.y, b * a.z}}; }

// diag(a) m diag(b)
Mat3d scaled(Vec3d a, const Mat3d& m, Vec3d b) {
  return {{m.row[0] * b * a.x, m.row[1] * b * a.y, m.row[2] * b * a.z}};
}

// The inverse of the covariance of a sample's error. [Sherman and Morrison 1950]
Mat3d precision_of(const ReflectionSample& s, Vec3f d, const SampleNoise& noise) {
  const Vec3d w = to_double(s.weight) / noise.color, diffuse = to_double(d * s.diffuse), u = w * diffuse;
  Mat3d p = diagonal(w);
  add(p, outer(u, u), -noise.diffuse / (1 + noise.diffuse * dot(diffuse, u)));
  return p;
}

bool is_regular(const Mat3d& m) {
  const double trace = m.row[0].x + m.row[1].y + m.row[2].z;
  return trace > 0 && determinant(m) > 1e-9 * trace * trace * trace;
}

Vec3f mean_reflected(const std::vector<ReflectionSample>& samples) {
  Vec3f above{0, 0, 0}, below{1e-20f, 1e-20f, 1e-20f};
  for (const ReflectionSample& s : samples) {
    above += s.weight * s.reflected;
    below += s.weight;
  }
  return above / below;
}

}  // namespace

Vec3f diffuse_of(const std::vector<ReflectionSample>& samples) {
  Vec3f above{0, 0, 0}, below{1e-20f, 1e-20f, 1e-20f};
  for (const ReflectionSample& s : samples) {
    above += s.weight * s.diffuse * (s.color - s.reflected);
    below += s.weight * s.diffuse * s.diffuse;
  }
  Vec3f d = above / below;
  for (int c = 0; c < 3; ++c) d[c] = max(d[c], 0.0f);
  return d;
}

void NoiseSums::add(const std::vector<ReflectionSample>& samples) {
  const Vec3f d = diffuse_of(samples), mean = mean_reflected(samples);
  for (const ReflectionSample& s : samples) {
    const Vec3f root{std::sqrt(s.weight.x), std::sqrt(s.weight.y), std::sqrt(s.weight.z)};
    const Vec3d diffuse = to_double(root * d * s.diffuse),
                error = to_double(root * (s.color - s.reflected - d * s.diffuse));
    const double square = dot(diffuse, diffuse),
                 along = square > 0 ? dot(error, diffuse) * dot(error, diffuse) / square : 0;
    reflected_ += to_double(s.weight * (s.reflected - mean) * (s.reflected - mean));
    along_ += along;
    across_ += (dot(error, error) - along) / 2;
    diffuse_ += square;
  }
  samples_ += samples.size();
}

SampleNoise NoiseSums::noise() const {
  if (samples_ == 0 || diffuse_ <= 0) return {};
  return {std::max(across_ / double(samples_), 1e-9), std::max(0.0, (along_ - across_) / diffuse_)};
}

void ScaleEquations::add(const std::vector<ReflectionSample>& samples, const SampleNoise& noise) {
  const Vec3f d = diffuse_of(samples);
  Mat3d dd{}, dt{}, tt{};
  Vec3d bd{0, 0, 0}, bt{0, 0, 0};
  for (const ReflectionSample& s : samples) {
    const Mat3d p = precision_of(s, d, noise);
    const Vec3d diffuse = to_double(s.diffuse), reflected = to_double(s.reflected),
                pc = p * to_double(s.color);
    cei3d::add(dd, scaled(diffuse, p, diffuse));
    cei3d::add(dt, scaled(diffuse, p, reflected));
    cei3d::add(tt, scaled(reflected, p, reflected));
    bd += diffuse * pc;
    bt += reflected * pc;
  }
  if (!is_regular(dd)) return;
  const Mat3d share = transpose(dt) * inverse(dd);
  cei3d::add(matrix, tt);
  cei3d::add(matrix, share * dt, -1);
  right += bt - share * bd;
}

LightScale light_scale(const std::vector<ScaleEquations>& places) {
  constexpr double kUnknown = 4;  // variance of the logarithms without evidence
  LightScale out{{1, 1, 1}, diagonal({kUnknown, kUnknown, kUnknown})};
  ScaleEquations all;
  for (const ScaleEquations& p : places) {
    add(all.matrix, p.matrix);
    all.right += p.right;
  }
  if (!is_regular(all.matrix)) return out;
  const Mat3d solution = inverse(all.matrix);
  const Vec3d t = solution * all.right;
  if (!(min(t.x, min(t.y, t.z)) > 0.05)) return out;
  out = {to_float(t), {}};
  for (const ScaleEquations& p : places) {
    const Vec3d error = solution * (p.right - p.matrix * t) / t;
    add(out.covariance, outer(error, error));
  }
  return out;
}

}  // namespace cei3d
