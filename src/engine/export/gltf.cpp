// SPDX-License-Identifier: Apache-2.0
#include "engine/export/gltf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/export/gltf_parts.h"

namespace cei3d {
namespace {

Json material_json(const Material& m) {
  Json j{{"pbrMetallicRoughness", {{"metallicFactor", m.metalness}, {"roughnessFactor", m.roughness}}}};
  if (m.specular != 0.5f) j["extensions"]["KHR_materials_specular"] = specular_extension(m.specular);
  return j;
}

void require_sound(const Mesh& mesh) {
  if (mesh.positions.empty() || mesh.triangles.empty())
    fail("There is no surface to export: the mesh is empty.");
  for (const Vec3f p : mesh.positions)
    if (!std::isfinite(dot(p, p))) fail("The mesh has a vertex that is not finite; it cannot be exported.");
}

using Triangles = std::vector<std::array<uint32_t, 3>>;

// Triangles of each material.
std::vector<Triangles> by_material(const Mesh& mesh, const MeshMaterials& materials) {
  std::vector<Triangles> groups(materials.list.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    groups.at(materials.of_triangle.empty() ? 0 : materials.of_triangle[t]).push_back(mesh.triangles[t]);
  return groups;
}

Json primitives_json(const Mesh& mesh, const MeshMaterials& materials, const Json& attributes,
                     GltfBuffer& buffer) {
  Json primitives = Json::array();
  const std::vector<Triangles> groups = by_material(mesh, materials);
  for (size_t m = 0; m < groups.size(); ++m)
    if (!groups[m].empty())
      primitives.push_back(
          {{"attributes", attributes}, {"indices", buffer.add_triangles(groups[m])}, {"material", m}});
  return primitives;
}

Json attributes_json(const Mesh& mesh, GltfBuffer& buffer) {
  const auto add = [&](const std::vector<Vec3f>& v) {
    return buffer.add_vertices(v.data(), v.size(), 3, "VEC3");
  };
  Json attributes;
  attributes["POSITION"] = buffer.add_positions(mesh.positions);
  if (mesh.normals.size() == mesh.positions.size()) attributes["NORMAL"] = add(mesh.normals);
  if (mesh.colors.size() != mesh.positions.size()) return attributes;
  std::vector<Vec3f> colors = mesh.colors;
  for (Vec3f& c : colors)
    for (int k = 0; k < 3; ++k) c[k] = std::clamp(c[k], 0.0f, 1.0f);
  attributes["COLOR_0"] = add(colors);
  return attributes;
}

}  // namespace

std::string encode_glb(const Mesh& mesh, const MeshMaterials& materials, const Placement& placement) {
  require_sound(mesh);
  GltfBuffer buffer;
  Json j = gltf_head("object", placement);
  const Json attributes = attributes_json(mesh, buffer);
  j["meshes"] = Json::array({{{"primitives", primitives_json(mesh, materials, attributes, buffer)}}});
  if (std::any_of(materials.list.begin(), materials.list.end(),
                  [](const Material& m) { return m.specular != 0.5f; }))
    j["extensionsUsed"] = Json::array({"KHR_materials_specular"});
  for (const Material& m : materials.list) j["materials"].push_back(material_json(m));
  return glb_of(std::move(j), std::move(buffer));
}

}  // namespace cei3d
