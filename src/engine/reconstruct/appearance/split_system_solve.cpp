// SPDX-License-Identifier: Apache-2.0
// SplitSystem's solution by conjugate gradients.
#include <array>

#include "engine/reconstruct/appearance/split_system.h"

namespace cei3d {

namespace {

struct Sums {
  double v[3] = {0, 0, 0};
};

Sums dot_product(const SplitUnknowns& a, const SplitUnknowns& b) {
  Sums s;
  for (const auto& [x, y] : {std::pair{&a.diffuse, &b.diffuse}, std::pair{&a.light, &b.light}})
    for (size_t i = 0; i < x->size(); ++i)
      for (int c = 0; c < 3; ++c) s.v[c] += double((*x)[i][c]) * (*y)[i][c];
  return s;
}

Vec3f ratio(const Sums& a, const Sums& b) {
  Vec3f r;
  for (int c = 0; c < 3; ++c) r[c] = b.v[c] > 1e-30 ? float(a.v[c] / b.v[c]) : 0.0f;
  return r;
}

template <class F>
void for_both(SplitUnknowns& a, const SplitUnknowns& b, F f) {
  for (size_t i = 0; i < a.diffuse.size(); ++i) f(a.diffuse[i], b.diffuse[i]);
  for (size_t i = 0; i < a.light.size(); ++i) f(a.light[i], b.light[i]);
}

// Unknowns at zero with a gradient that would make them negative are frozen for a round.
struct Frozen {
  std::vector<std::array<uint8_t, 3>> light, diffuse;

  Frozen(const SplitUnknowns& x, const SplitUnknowns& rest)
      : light(of(x.light, rest.light)), diffuse(of(x.diffuse, rest.diffuse)) {}
  void mask(SplitUnknowns& x) const {
    mask(light, x.light);
    mask(diffuse, x.diffuse);
  }

 private:
  static std::vector<std::array<uint8_t, 3>> of(const std::vector<Vec3f>& x, const std::vector<Vec3f>& rest) {
    std::vector<std::array<uint8_t, 3>> out(x.size());
    for (size_t i = 0; i < x.size(); ++i)
      for (int c = 0; c < 3; ++c) out[i][size_t(c)] = x[i][c] <= 0 && rest[i][c] < 0;
    return out;
  }
  static void mask(const std::vector<std::array<uint8_t, 3>>& frozen, std::vector<Vec3f>& x) {
    for (size_t i = 0; i < frozen.size(); ++i)
      for (int c = 0; c < 3; ++c)
        if (frozen[i][size_t(c)]) x[i][c] = 0;
  }
};

void clamp_at_zero(std::vector<Vec3f>& x) {
  for (Vec3f& v : x)
    for (int c = 0; c < 3; ++c) v[c] = max(v[c], 0.0f);
}

}  // namespace

void SplitSystem::descend(SplitUnknowns& x, const SplitUnknowns& inverse, int steps) const {
  SplitUnknowns r, ax;
  right_side(r);
  normal(x, ax);
  for_both(r, ax, [](Vec3f& a, const Vec3f& b) { a = a - b; });
  const Frozen frozen(x, r);
  frozen.mask(r);
  SplitUnknowns z = r;
  for_both(z, inverse, [](Vec3f& a, const Vec3f& b) { a = a * b; });
  SplitUnknowns p = z;
  Sums rz = dot_product(r, z);
  for (int k = 0; k < steps; ++k) {
    normal(p, ax);
    frozen.mask(ax);
    const Vec3f alpha = ratio(rz, dot_product(p, ax));
    for_both(x, p, [&](Vec3f& a, const Vec3f& b) { a += alpha * b; });
    for_both(r, ax, [&](Vec3f& a, const Vec3f& b) { a = a - alpha * b; });
    z = r;
    for_both(z, inverse, [](Vec3f& a, const Vec3f& b) { a = a * b; });
    const Sums next = dot_product(r, z);
    const Vec3f beta = ratio(next, rz);
    rz = next;
    for_both(p, z, [&](Vec3f& a, const Vec3f& b) { a = b + beta * a; });
  }
}

void SplitSystem::solve(SplitUnknowns& x, int rounds, int steps) {
  for (uint32_t v = 0; v < x.diffuse.size(); ++v)
    if (materials_.is_metal(v)) x.diffuse[v] = {0, 0, 0};
  SplitUnknowns inverse = diagonal();
  Vec3f mean_light{0, 0, 0}, mean_diffuse{0, 0, 0};
  for (const Vec3f& d : inverse.light) mean_light += d / float(inverse.light.size());
  for (const Vec3f& d : inverse.diffuse) mean_diffuse += d / float(inverse.diffuse.size());
  light_smoothness_ = options_.smoothness * (mean_light.x + mean_light.y + mean_light.z) / 3;
  diffuse_smoothness_ = 1e-3f * (mean_diffuse.x + mean_diffuse.y + mean_diffuse.z) / 3;
  for (Vec3f& d : inverse.light)
    for (int c = 0; c < 3; ++c) d[c] = 1 / (d[c] + 4 * light_smoothness_ + 1e-3f * mean_light[c] + 1e-20f);
  for (Vec3f& d : inverse.diffuse)
    for (int c = 0; c < 3; ++c) d[c] = 1 / (d[c] + 6 * diffuse_smoothness_ + 1e-20f);
  for (int round = 0; round < rounds; ++round) {
    release_bounds(x);
    descend(x, inverse, steps);
    clamp_at_zero(x.light);
    clamp_at_zero(x.diffuse);
  }
}

}  // namespace cei3d
