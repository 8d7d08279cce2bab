// SPDX-License-Identifier: Apache-2.0
#include "engine/export/gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr int kFloat = 5126, kUint32 = 5125, kVertexTarget = 34962,
              kIndexTarget = 34963;  // OpenGL's names for them

// The binary buffer with its views and accessors.
class Buffer {
 public:
  // Appends an array; returns its accessor's index.
  int add(const void* data, size_t bytes, size_t count, const char* type, int component, int target) {
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}, {"target", target}});
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    bytes_.append(static_cast<const char*>(data), bytes);  // all arrays are multiples of 4 bytes: aligned
    return int(accessors_.size()) - 1;
  }
  int add(const std::vector<Vec3f>& v) {
    return add(v.data(), v.size() * sizeof(Vec3f), v.size(), "VEC3", kFloat, kVertexTarget);
  }
  Json& accessor(int i) { return accessors_[size_t(i)]; }
  Json views_ = Json::array(), accessors_ = Json::array();
  std::string bytes_;
};

void set_bounds(Json& accessor, const std::vector<Vec3f>& v) {  // required of POSITION
  Vec3f lo = v[0], hi = v[0];
  for (const Vec3f p : v)
    for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], p[a]), hi[a] = std::max(hi[a], p[a]);
  accessor["min"] = {lo.x, lo.y, lo.z};
  accessor["max"] = {hi.x, hi.y, hi.z};
}

// Shortest rotation of `up` to +Y as x, y, z, w.
Json rotation_to_y(Vec3d up) {
  const Vec3d u = normalize(up), axis = cross(u, Vec3d{0, 1, 0});
  const double w = 1 + u.y;
  if (w < 1e-9) return {1.0, 0.0, 0.0, 0.0};  // upside down: half a turn about X
  const double n = 1 / std::sqrt(dot(axis, axis) + w * w);
  return {axis.x * n, axis.y * n, axis.z * n, w * n};
}

Json material_json(const Material& m) {
  Json j{{"pbrMetallicRoughness", {{"metallicFactor", m.metalness}, {"roughnessFactor", m.roughness}}}};
  // The extension's F0 is 0.04 specularColorFactor; its specularFactor would dim grazing reflections too.
  if (m.specular != 0.5f) {
    const float s = 2 * m.specular;
    j["extensions"]["KHR_materials_specular"] = {{"specularColorFactor", {s, s, s}}};
  }
  return j;
}

void append_chunk(std::string& out, const char* type, std::string data, char padding) {
  data.append((4 - data.size() % 4) % 4, padding);
  const uint32_t size = uint32_t(data.size());
  append_bytes(out, size);
  out.append(type, 4);
  out += data;
}

void require_sound(const Mesh& mesh) {
  if (mesh.positions.empty() || mesh.triangles.empty())
    fail("There is no surface to export: the mesh is empty.");
  for (const Vec3f p : mesh.positions)
    if (!std::isfinite(dot(p, p))) fail("The mesh has a vertex that is not finite; it cannot be exported.");
}

}  // namespace

namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

// Triangles of each material.
std::vector<Triangles> by_material(const Mesh& mesh, const MeshMaterials& materials) {
  std::vector<Triangles> groups(materials.list.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    groups.at(materials.of_triangle.empty() ? 0 : materials.of_triangle[t]).push_back(mesh.triangles[t]);
  return groups;
}

Json primitives_json(const Mesh& mesh, const MeshMaterials& materials, const Json& attributes,
                     Buffer& buffer) {
  Json primitives = Json::array();
  const std::vector<Triangles> groups = by_material(mesh, materials);
  for (size_t m = 0; m < groups.size(); ++m) {
    if (groups[m].empty()) continue;
    const int indices = buffer.add(groups[m].data(), groups[m].size() * 12, groups[m].size() * 3, "SCALAR",
                                   kUint32, kIndexTarget);
    primitives.push_back({{"attributes", attributes}, {"indices", indices}, {"material", m}});
  }
  return primitives;
}

}  // namespace

std::string encode_glb(const Mesh& mesh, const MeshMaterials& materials, Vec3d up) {
  require_sound(mesh);
  Buffer buffer;
  Json attributes;
  attributes["POSITION"] = buffer.add(mesh.positions);
  set_bounds(buffer.accessor(0), mesh.positions);
  if (mesh.normals.size() == mesh.positions.size()) attributes["NORMAL"] = buffer.add(mesh.normals);
  if (mesh.colors.size() == mesh.positions.size()) {
    std::vector<Vec3f> colors = mesh.colors;
    for (Vec3f& c : colors)
      for (int k = 0; k < 3; ++k) c[k] = std::clamp(c[k], 0.0f, 1.0f);
    attributes["COLOR_0"] = buffer.add(colors);
  }
  const Json primitives = primitives_json(mesh, materials, attributes, buffer);
  if (buffer.bytes_.size() > 0xf0000000u)
    fail("The mesh is too large for a GLB file (4 GB); export fewer faces.");

  Json j{{"asset", {{"version", "2.0"}, {"generator", "CEI-3D"}}}};
  if (std::any_of(materials.list.begin(), materials.list.end(),
                  [](const Material& m) { return m.specular != 0.5f; }))
    j["extensionsUsed"] = {"KHR_materials_specular"};
  j["scene"] = 0;
  j["scenes"] = Json::array({{{"nodes", {0}}}});
  j["nodes"] = Json::array({{{"mesh", 0}, {"name", "object"}, {"rotation", rotation_to_y(up)}}});
  j["meshes"] = Json::array({{{"primitives", primitives}}});
  j["materials"] = Json::array();
  for (const Material& m : materials.list) j["materials"].push_back(material_json(m));
  j["accessors"] = buffer.accessors_;
  j["bufferViews"] = buffer.views_;
  j["buffers"] = Json::array({{{"byteLength", buffer.bytes_.size()}}});

  std::string chunks;
  append_chunk(chunks, "JSON", j.dump(), ' ');
  append_chunk(chunks, std::string("BIN\0", 4).c_str(), std::move(buffer.bytes_), '\0');
  std::string out;
  append_bytes(out, std::array<uint32_t, 3>{0x46546c67, 2, uint32_t(12 + chunks.size())});  // "glTF"
  return out + chunks;
}

void write_glb(const std::filesystem::path& path, const Mesh& mesh, const MeshMaterials& materials,
               Vec3d up) {
  write_file_atomic(path, encode_glb(mesh, materials, up));
}

}  // namespace cei3d
