// SPDX-License-Identifier: Apache-2.0
// What all glTF files of the program are put together from. [Khronos glTF 2.0]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/math/vec.h"
#include "engine/export/placement.h"

namespace cei3d {

// The binary buffer with its views and accessors.
class GltfBuffer {
 public:
  // Appends an array of vertices; returns its accessor's index. type: "VEC2" to "VEC4".
  int add_vertices(const void* data, size_t count, int floats, const char* type);
  int add_positions(std::span<const Vec3f> positions);  // with their bounds, which glTF requires
  int add_triangles(std::span<const std::array<uint32_t, 3>> triangles);
  // Appends a file; returns its view's index.
  int add_file(const std::string& bytes);

  size_t size() const { return bytes_.size(); }
  // Adds accessors, views and the buffer itself to a description. uri: of the buffer; empty: of a GLB.
  void describe(Json& gltf, const std::string& uri) const;
  std::string take_bytes() { return std::move(bytes_); }

 private:
  int add(const void* data, size_t bytes, size_t count, const char* type, int component, int target);
  int add_view(const void* data, size_t bytes);

  Json views_ = Json::array(), accessors_ = Json::array();
  std::string bytes_;
};

// asset, scene and the one node; `mesh` 0 is left to the caller.
Json gltf_head(const std::string& name, const Placement& placement);

// KHR_materials_specular of a specular strength. Its F0 is 0.04 specularColorFactor * specularFactor, its F90
// specularFactor.
Json specular_extension(float specular);

// Error: larger than the format can say.
std::string glb_of(Json gltf, GltfBuffer buffer);

}  // namespace cei3d
