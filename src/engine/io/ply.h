// SPDX-License-Identifier: Apache-2.0
// PLY meshes, binary little endian.
#pragma once

#include <filesystem>
#include <string>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// Writes x y z, nx ny nz where the mesh has normals, red green blue (sRGB, 8 bits) where it has colors, and
// triangles. Coordinates are written as they are: transform to the capture frame first.
std::string encode_ply(const Mesh& mesh);
void write_ply(const std::filesystem::path& path, const Mesh& mesh);  // atomically

// Reads any scalar properties (unknown ones are skipped) and splits polygons into fans. Errors name the file:
// not a binary little-endian PLY, truncated, indices out of range.
Mesh decode_ply(const std::string& bytes, const std::string& name);
Mesh read_ply(const std::filesystem::path& path);

}  // namespace cei3d
