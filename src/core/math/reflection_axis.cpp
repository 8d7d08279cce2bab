// SPDX-License-Identifier: Apache-2.0
#include "core/math/reflection_axis.h"

#include <algorithm>
#include <vector>

#include "core/math/facets.h"
#include "core/math/reflection.h"

namespace cei3d {
namespace {

// Mean direction of the light of that part that reaches a viewer; its y is 0.
Vec3d mean_direction(ReflectionPart part, double nv, double roughness) {
  Vec3d sum{0, 0, 0};
  double total = 0;
  for_reflections(nv, roughness, [&](double weight, const Vec3d& l, double vh) {
    const double fresnel = schlick(0.0, vh), share = part == ReflectionPart::base ? 1 - fresnel : fresnel;
    sum += l * (weight * share);
    total += weight * share;
  });
  return Vec3d{sum.x, 0, sum.z} / total;
}

// Length of the mean direction of reflection_lobe().
double mean_length(double roughness) {
  const double scale = reflection_scale(roughness);
  double sum = 0;
  for (int j = 0; j < kReflectionLobes; ++j) {
    const double lambda = reflection_node(j) * scale;
    sum += reflection_share(j) * (1 / std::tanh(lambda) - 1 / lambda);
  }
  return sum;
}

// Table of the length of the mean direction of reflection_lobe() over roughness, and its inverse.
class Widths {
 public:
  Widths() {
    for (int i = 0; i <= kSteps; ++i) widths_.push_back(1 - mean_length(roughness_at(i)));
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
  static constexpr double kMin = 0.5 * kMinRoughness, kMax = 1.2;  // the mixture is narrower than rough lobes
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

PairTable make_table(ReflectionPart part) {
  const Widths widths;
  return make_pair_table([&](double nv, double roughness) {
    const double cosine = std::min(nv, frontal(part));
    const Vec3d mean = mean_direction(part, cosine, roughness);
    return TablePair<double>{share_of_normal(cosine, mean), widths.roughness(1 - length(mean)) / roughness};
  });
}

}  // namespace

const float* reflection_axis_table(ReflectionPart part) {
  static const PairTable base = make_table(ReflectionPart::base),
                         fresnel = make_table(ReflectionPart::fresnel);
  return part == ReflectionPart::base ? base.data() : fresnel.data();
}

ReflectionTables reflection_tables() {
  return {split_sum_table(), reflection_axis_table(ReflectionPart::base),
          reflection_axis_table(ReflectionPart::fresnel)};
}

}  // namespace cei3d
