// SPDX-License-Identifier: Apache-2.0
// NumPy's .npy files. Writes float32 in C order; reads more. [NEP 1]
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace cei3d {

struct NpyArray {
  std::vector<int64_t> shape;
  std::vector<double> data;  // C order
  std::vector<float> floats() const { return {data.begin(), data.end()}; }
};

// values: [rows][columns]
std::string encode_npy(std::span<const float> values, int64_t rows, int64_t columns);
void write_npy(const std::filesystem::path& path, std::span<const float> values, int64_t rows,
               int64_t columns);  // atomically

// float32 or float64 (little endian), any shape; Fortran order up to two dimensions. Errors name the file.
NpyArray decode_npy(const std::string& bytes, const std::string& name);
NpyArray read_npy(const std::filesystem::path& path);

}  // namespace cei3d
