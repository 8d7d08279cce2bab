// SPDX-License-Identifier: Apache-2.0
// Vectors in JSON: lists of three numbers.
#pragma once

#include "core/base/json.h"
#include "core/base/json_reader.h"
#include "core/math/vec.h"

namespace cei3d {

inline Json vector_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }
inline Json vector_json(Vec3f v) { return vector_json(to_double(v)); }

// Error: no list of three numbers.
inline Vec3d vector_from(JsonReader& reader, const char* key) {
  const auto [x, y, z] = reader.numbers<3>(key);
  return {x, y, z};
}

}  // namespace cei3d
