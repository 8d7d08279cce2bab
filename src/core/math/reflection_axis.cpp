// SPDX-License-Identifier: Apache-2.0
#include "core/math/reflection_axis.h"

#include <algorithm>
#include <vector>

#include "core/math/facets.h"
#include "core/math/reflection.h"

namespace cei3d {
namespace {

// First and second moments of the light of that part that reaches a viewer; the y of the mean is 0.
struct Moments {
  Vec3d mean{0, 0, 0};
  double xx = 0, xz = 0, zz = 0, yy = 0;
};

Moments moments(ReflectionPart part, double nv, double roughness) {
  Moments m;
  double total = 0;
  for_reflections(nv, roughness, [&](double weight, const Vec3d& l, double vh) {
    const double rise = fresnel(0.0, vh), share = weight * (part == ReflectionPart::base ? 1 - rise : rise);
    m.mean += l * share;
    m.xx += share * l.x * l.x;
    m.xz += share * l.x * l.z;
    m.zz += share * l.z * l.z;
    m.yy += share * l.y * l.y;
    total += share;
  });
  m.mean = Vec3d{m.mean.x, 0, m.mean.z} / total;
  m.xx /= total, m.xz /= total, m.zz /= total, m.yy /= total;
  return m;
}

// Standard deviation along the plane of incidence over that across it.
double stretch_of(const Moments& m) {
  constexpr double kMax = 4;
  const Vec3d axis = normalize(m.mean);
  const double along = axis.z * axis.z * m.xx - 2 * axis.x * axis.z * m.xz + axis.x * axis.x * m.zz;
  return clamp(std::sqrt(along / m.yy), 1.0, kMax);
}

// Table of reflection_width() over roughness, and its inverse.
class Widths {
 public:
  Widths() {
    for (int i = 0; i <= kSteps; ++i) widths_.push_back(reflection_width(roughness_at(i)));
  }
  double roughness(double width) const {
    const auto next = std::upper_bound(widths_.begin(), widths_.end(), width);
    if (next == widths_.begin()) return roughness_at(0);
    if (next == widths_.end()) return roughness_at(kSteps);
    const double below = next[-1], share = (width - below) / (*next - below);
    return roughness_at(double(next - widths_.begin() - 1) + share);
  }

 private:
  static constexpr int kSteps = 200;
  static constexpr double kMin = kMinRoughness, kMax = 1.2;  // the mixture is narrower than rough lobes
  static double roughness_at(double i) { return kMin + (kMax - kMin) * i / kSteps; }
  std::vector<double> widths_;  // rising with roughness
};

// Share s of the normal with which mirror direction (1 - s) + normal s points along the mean; below 0 where
// the mean is at a more grazing angle than the mirror direction.
double share_of_normal(double nv, Vec3d mean) {
  constexpr double kMin = -0.5;
  const double sine = std::sqrt(1 - nv * nv), towards = -mean.x / mean.z;  // tangent of the axis' angle
  const double normal = std::max(sine / std::max(towards, 1e-6) - nv, kMin);
  return normal / (1 + normal);
}

// Above these cosines the mirror direction is too close to the normal to determine the share, and the Fresnel
// part is negligible.
constexpr double frontal(ReflectionPart part) { return part == ReflectionPart::base ? 0.999 : 0.85; }

// value: moments, roughness -> TablePair.
template <class F>
PairTable make_table(ReflectionPart part, const F& value) {
  return make_pair_table([&](double nv, double roughness) {
    const double cosine = std::min(nv, frontal(part));
    return value(cosine, roughness, moments(part, cosine, roughness));
  });
}

PairTable make_axis_table(ReflectionPart part) {
  return make_table(part, [widths = Widths()](double nv, double roughness, const Moments& m) {
    return TablePair<double>{share_of_normal(nv, m.mean), widths.roughness(1 - length(m.mean)) / roughness};
  });
}

// The variances of a stretched lobe are those of the round one times the stretch, and divided by it.
PairTable make_stretch_table(ReflectionPart part) {
  return make_table(part, [widths = Widths()](double, double roughness, const Moments& m) {
    const double stretch = stretch_of(m), round = (1 - length(m.mean)) / ((stretch + 1 / stretch) / 2);
    return TablePair<double>{widths.roughness(round) / roughness, stretch};
  });
}

}  // namespace

const float* reflection_axis_table(ReflectionPart part) {
  static const PairTable base = make_axis_table(ReflectionPart::base),
                         fresnel = make_axis_table(ReflectionPart::fresnel);
  return part == ReflectionPart::base ? base.data() : fresnel.data();
}

const float* reflection_stretch_table(ReflectionPart part) {
  static const PairTable base = make_stretch_table(ReflectionPart::base),
                         fresnel = make_stretch_table(ReflectionPart::fresnel);
  return part == ReflectionPart::base ? base.data() : fresnel.data();
}

ReflectionTables reflection_tables() {
  const auto of = [](ReflectionPart part) {
    return PartTables{reflection_axis_table(part), reflection_stretch_table(part)};
  };
  return {split_sum_table(), of(ReflectionPart::base), of(ReflectionPart::fresnel)};
}

}  // namespace cei3d
