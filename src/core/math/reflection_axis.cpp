// SPDX-License-Identifier: Apache-2.0
#include "core/math/reflection_axis.h"

namespace cei3d {
namespace {

PairTable table_of(const FittedPairs& pairs) {
  return make_pair_table_of_nodes([&](int roughness, int cosine) {
    const float* pair = &pairs[2 * (roughness * kTableCosines + cosine)];
    return TablePair<double>{pair[0], pair[1]};
  });
}

}  // namespace

const float* reflection_axis_table(ReflectionPart part) {
  static const PairTable base = table_of(reflection_pairs(ReflectionPart::base).axis),
                         fresnel = table_of(reflection_pairs(ReflectionPart::fresnel).axis);
  return part == ReflectionPart::base ? base.data() : fresnel.data();
}

const float* reflection_stretch_table(ReflectionPart part) {
  static const PairTable base = table_of(reflection_pairs(ReflectionPart::base).stretch),
                         fresnel = table_of(reflection_pairs(ReflectionPart::fresnel).stretch);
  return part == ReflectionPart::base ? base.data() : fresnel.data();
}

ReflectionTables reflection_tables() {
  const auto of = [](ReflectionPart part) {
    return PartTables{reflection_axis_table(part), reflection_stretch_table(part)};
  };
  return {split_sum_table(), of(ReflectionPart::base), of(ReflectionPart::fresnel)};
}

}  // namespace cei3d
