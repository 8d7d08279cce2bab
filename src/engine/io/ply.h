// SPDX-License-Identifier: Apache-2.0
// Meshes as PLY, binary little endian.
#pragma once

#include <filesystem>
#include <string>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// x y z, nx ny nz where the mesh has normals, red green blue (sRGB, 8 bits) where it has colors, and
// triangles. Coordinates go out as they are: transform to the capture's frame first.
std::string encode_ply(const Mesh& mesh);
void write_ply(const std::filesystem::path& path, const Mesh& mesh);  // atomically

// Any scalar properties (unknown ones are skipped); polygons become fans. Errors name the file: not a binary
// little-endian PLY, truncated, indices that don't exist.
Mesh decode_ply(const std::string& bytes, const std::string& name);
Mesh read_ply(const std::filesystem::path& path);

}  // namespace cei3d
