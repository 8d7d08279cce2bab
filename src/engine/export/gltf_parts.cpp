// SPDX-License-Identifier: Apache-2.0
#include "engine/export/gltf_parts.h"

#include <algorithm>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/axis_box.h"
#include "core/math/shading.h"

namespace cei3d {
namespace {

constexpr int kFloat = 5126, kUint32 = 5125, kVertexTarget = 34962,
              kIndexTarget = 34963;  // OpenGL's names for them

void append_chunk(std::string& out, const char* type, std::string data, char padding) {
  data.append((4 - data.size() % 4) % 4, padding);
  const uint32_t size = uint32_t(data.size());
  append_bytes(out, size);
  out.append(type, 4);
  out += data;
}

}  // namespace

int GltfBuffer::add_view(const void* data, size_t bytes) {
  bytes_.append((4 - bytes_.size() % 4) % 4, '\0');
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}});
  bytes_.append(static_cast<const char*>(data), bytes);
  return int(views_.size()) - 1;
}

int GltfBuffer::add(const void* data, size_t bytes, size_t count, const char* type, int component,
                    int target) {
  const int view = add_view(data, bytes);
  views_.back()["target"] = target;
  accessors_.push_back(
      {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  return int(accessors_.size()) - 1;
}

int GltfBuffer::add_vertices(const void* data, size_t count, int floats, const char* type) {
  return add(data, count * size_t(floats) * sizeof(float), count, type, kFloat, kVertexTarget);
}

int GltfBuffer::add_positions(std::span<const Vec3f> v) {
  const int id = add_vertices(v.data(), v.size(), 3, "VEC3");
  const auto [low, high] = box_of(v);
  accessors_.back()["min"] = {low.x, low.y, low.z};
  accessors_.back()["max"] = {high.x, high.y, high.z};
  return id;
}

int GltfBuffer::add_triangles(std::span<const std::array<uint32_t, 3>> t) {
  return add(t.data(), t.size() * 12, t.size() * 3, "SCALAR", kUint32, kIndexTarget);
}

int GltfBuffer::add_file(const std::string& bytes) { return add_view(bytes.data(), bytes.size()); }

void GltfBuffer::describe(Json& gltf, const std::string& uri) const {
  gltf["accessors"] = accessors_;
  gltf["bufferViews"] = views_;
  Json buffer{{"byteLength", bytes_.size()}};
  if (!uri.empty()) buffer["uri"] = uri;
  gltf["buffers"].push_back(buffer);
}

Json gltf_head(const std::string& name, const Placement& p) {
  Json node{{"mesh", 0}, {"name", name}, {"rotation", p.rotation}};
  if (p.scale != 1) node["scale"] = {p.scale, p.scale, p.scale};
  if (dot(p.translation, p.translation) > 0)
    node["translation"] = {p.translation.x, p.translation.y, p.translation.z};
  Json j{{"asset", {{"version", "2.0"}, {"generator", "CEI-3D"}}}};
  j["scene"] = 0;
  j["scenes"] = Json::array({{{"nodes", {0}}}});
  j["nodes"].push_back(node);
  return j;
}

Json specular_extension(float specular) {
  const float s = max(specular / kUsualSpecular, 1.0f);
  return {{"specularFactor", f90_of(specular, 0.0f)}, {"specularColorFactor", {s, s, s}}};
}

std::string glb_of(Json gltf, GltfBuffer buffer) {
  if (buffer.size() > 0xf0000000u)
    fail("The object is too large for a GLB file (4 GB); export fewer faces or a smaller texture.");
  buffer.describe(gltf, "");
  std::string chunks;
  append_chunk(chunks, "JSON", gltf.dump(), ' ');
  append_chunk(chunks, std::string("BIN\0", 4).c_str(), buffer.take_bytes(), '\0');
  std::string out;
  append_bytes(out, std::array<uint32_t, 3>{0x46546c67, 2, uint32_t(12 + chunks.size())});  // "glTF"
  return out + chunks;
}

}  // namespace cei3d
