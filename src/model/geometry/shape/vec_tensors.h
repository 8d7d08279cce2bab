// SPDX-License-Identifier: Apache-2.0
// Arrays of vectors and triangles as tensors. Reading errors: missing tensor, wrong shape or type.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/tensors.h"
#include "core/math/vec.h"

namespace cei3d {

Tensor tensor_of(std::span<const Vec3f> rows);  // [n][3] floats
std::vector<Vec3f> vectors_from(const Tensors&, const std::string& name, int64_t rows);

// [n][4 columns] bytes: little-endian u32 each, since the store knows F32 and U8 only.
Tensor tensor_of(std::span<const uint32_t> numbers);
std::vector<uint32_t> numbers_from(const Tensors&, const std::string& name, int64_t rows);
Tensor tensor_of(std::span<const std::array<uint32_t, 3>> triangles);
std::vector<std::array<uint32_t, 3>> triangles_from(const Tensors&, const std::string& name, int64_t rows);

// A number of rows from a stored description.
int64_t rows_from(const Json&);

}  // namespace cei3d
