// SPDX-License-Identifier: Apache-2.0
// The fitted tables behind core/math/reflection_axis.h, printed by tools/fit_reflection.py.
#pragma once

#include "core/math/pair_table.h"

namespace cei3d {

// The parts of the split sum: base is scaled by F0, fresnel is what Fresnel's term adds to it at grazing
// angles.
enum class ReflectionPart { base, fresnel };

// Pairs at the nodes of a PairTable without its borders, [roughness][cosine][first, second].
using FittedPairs = float[kTableRoughnesses * kTableCosines * 2];

struct ReflectionPairs {
  const FittedPairs& axis;     // as reflection_axis_table()
  const FittedPairs& stretch;  // as reflection_stretch_table()
};
ReflectionPairs reflection_pairs(ReflectionPart);

}  // namespace cei3d
