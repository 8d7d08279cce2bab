// SPDX-License-Identifier: Apache-2.0
// PLY meshes, binary little endian.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// A further value of every vertex, 0 to 255 or any number.
struct PlyProperty {
  std::string name;
  std::variant<std::vector<uint8_t>, std::vector<float>> values;  // #V
};
struct PlyExtras {
  std::vector<std::string> comments;  // lines of the header, without line breaks
  std::vector<PlyProperty> properties;
};

// Writes x y z, nx ny nz where the mesh has normals, red green blue (sRGB, 8 bits) where it has colors, the
// properties, and triangles. Coordinates are written as they are: transform to the capture frame first.
std::string encode_ply(const Mesh& mesh, const PlyExtras& extras = {});
void write_ply(const std::filesystem::path& path, const Mesh& mesh);  // atomically

// Reads any scalar properties (unknown ones are skipped) and splits polygons into fans. Errors name the file:
// not a binary little-endian PLY, truncated, indices out of range.
Mesh decode_ply(const std::string& bytes, const std::string& name);
Mesh read_ply(const std::filesystem::path& path);

}  // namespace cei3d
