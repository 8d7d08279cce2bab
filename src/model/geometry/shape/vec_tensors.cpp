// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/vec_tensors.h"

#include <cstring>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

static_assert(sizeof(Vec3f) == 3 * sizeof(float));
using Triangle = std::array<uint32_t, 3>;
static_assert(sizeof(Triangle) == 12);

template <class Row>
Tensor bytes_of(std::span<const Row> rows) {
  Tensor t{{int64_t(rows.size()), int64_t(sizeof(Row))}, {}, std::vector<uint8_t>(rows.size_bytes())};
  if (!rows.empty()) std::memcpy(t.u8.data(), rows.data(), rows.size_bytes());
  return t;
}

template <class Row>
std::vector<Row> rows_of_bytes(const Tensors& in, const std::string& name, int64_t rows) {
  const Tensor& t = require_bytes(in, name, {rows, int64_t(sizeof(Row))});
  std::vector<Row> out(static_cast<size_t>(rows));
  if (!out.empty()) std::memcpy(out.data(), t.u8.data(), t.u8.size());
  return out;
}

}  // namespace

Tensor tensor_of(std::span<const Vec3f> rows) {
  Tensor t{{int64_t(rows.size()), 3}, std::vector<float>(3 * rows.size()), {}};
  if (!rows.empty()) std::memcpy(t.f32.data(), rows.data(), rows.size_bytes());
  return t;
}

std::vector<Vec3f> vectors_from(const Tensors& in, const std::string& name, int64_t rows) {
  const Tensor& t = require_tensor(in, name, {rows, 3});
  std::vector<Vec3f> v(static_cast<size_t>(rows));
  if (!v.empty()) std::memcpy(v.data(), t.f32.data(), t.f32.size() * sizeof(float));
  return v;
}

Tensor tensor_of(std::span<const uint32_t> numbers) { return bytes_of(numbers); }
std::vector<uint32_t> numbers_from(const Tensors& in, const std::string& name, int64_t rows) {
  return rows_of_bytes<uint32_t>(in, name, rows);
}

Tensor tensor_of(std::span<const Triangle> triangles) { return bytes_of(triangles); }
std::vector<Triangle> triangles_from(const Tensors& in, const std::string& name, int64_t rows) {
  return rows_of_bytes<Triangle>(in, name, rows);
}

int64_t rows_from(const Json& j) {
  const int64_t n = j.get<int64_t>();
  if (n < 0 || n > (int64_t(1) << 32))
    fail("A size in a stored description is {}. Restore the project from a copy.", n);
  return n;
}

}  // namespace cei3d
