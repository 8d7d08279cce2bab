// SPDX-License-Identifier: Apache-2.0
// Named arrays: models, checkpoints and projects on disk (safetensors files).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cei3d {

struct Tensor {
  std::vector<int64_t> shape;
  std::vector<float> f32;  // exactly one of f32 and u8 is used
  std::vector<uint8_t> u8;
};
using Tensors = std::map<std::string, Tensor>;

// Whole-file read and atomic write (temporary name, fsync, rename) in the safetensors format (dtypes F32 and
// U8). Errors: missing, truncated or malformed file; a full disk (the old file is then unchanged).
Tensors read_tensors(const std::filesystem::path&);
void write_tensors(const std::filesystem::path&, const Tensors&);
std::string tensors_to_bytes(const Tensors&);
Tensors tensors_from_bytes(const std::string& bytes, const std::string& name_for_errors);

// The array of that name. Error: it is missing.
const Tensor& require_tensor(const Tensors& in, const std::string& name);
// The array of floats, or of bytes, of that name. Errors: it is missing, or of another shape or type.
const Tensor& require_tensor(const Tensors& in, const std::string& name, const std::vector<int64_t>& shape);
const Tensor& require_bytes(const Tensors& in, const std::string& name, const std::vector<int64_t>& shape);

}  // namespace cei3d
