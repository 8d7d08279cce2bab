// SPDX-License-Identifier: Apache-2.0
#include "engine/export/object_mesh.h"

#include <cmath>
#include <map>
#include <tuple>

#include "core/base/error.h"
#include "engine/io/ply.h"
#include "model/geometry/mesh/compact.h"
#include "model/geometry/mesh/simplify.h"
#include "model/scene/appearance.h"
#include "model/scene/handler_hits.h"

namespace cei3d {
namespace {

std::vector<Vec3f> in_capture_frame(std::vector<Vec3f> points, const Normalization& n) {
  for (Vec3f& p : points) p = to_float(n.capture_from_unit(to_double(p)));
  return points;
}

// A mesh has few materials: where they vary continuously they are rounded.
std::vector<Material> rounded(std::vector<Material> materials) {
  constexpr float kStep = 0.1f;  // step of the roughness
  for (Material& m : materials)
    m = {kStep * std::round(m.roughness / kStep), m.specular, std::round(m.metalness)};
  return materials;
}

// The materials that occur among the vertices. A triangle gets the one that two of its corners have, else its
// first corner's.
MeshMaterials mesh_materials(const Mesh& mesh, const std::vector<Material>& of_vertex) {
  std::map<std::tuple<float, float, float>, uint32_t> ids;
  MeshMaterials out;
  for (const auto& t : mesh.triangles) {
    const Material &a = of_vertex[t[0]], &b = of_vertex[t[1]], &c = of_vertex[t[2]];
    const Material& m = b == c ? b : a;
    const auto [id, is_new] =
        ids.emplace(std::tuple(m.roughness, m.specular, m.metalness), uint32_t(ids.size()));
    if (is_new) out.list.push_back(m);
    out.of_triangle.push_back(id->second);
  }
  return out;
}

}  // namespace

ColoredMesh colored_mesh(const Device& device, const Scene& scene, size_t faces) {
  if (!scene.surface || !scene.albedo) fail("The object has no surface to export; reconstruct it again.");
  Mesh mesh = scene.surface->mesh();
  if (mesh.triangles.empty()) fail("There is no surface to export: the mesh is empty.");
  Appearance look = appearance_at(device, scene, vertex_hits(mesh));
  mesh.colors = std::move(look.albedo);
  if (scene.material.varying()) look.material = rounded(std::move(look.material));
  double error = 0;
  if (faces > 0) {
    Simplified simple = simplified(mesh, faces);
    mesh = std::move(simple.mesh);
    error = double(simple.error) / scene.normalization.scale;
    std::vector<Material> kept;
    for (const uint32_t v : simple.vertex) kept.push_back(look.material[v]);
    look.material = std::move(kept);
  }
  MeshMaterials materials = mesh_materials(mesh, look.material);
  if (!scene.shape_versions.empty()) mesh = compact(mesh, mesh.triangles);
  mesh.positions = in_capture_frame(std::move(mesh.positions), scene.normalization);
  return {std::move(mesh), std::move(materials), error};
}

HandlerCloud handler_cloud(const Device& device, const Scene& scene) {
  if (!scene.handlers) fail("The object has no handler points; reconstruct it again.");
  const std::vector<Hit> hits = handler_hits(scene);
  HandlerCloud out{{in_capture_frame(scene.handlers->positions, scene.normalization),
                    scene.handlers->normals,
                    appearance_at(device, scene, hits).albedo,
                    {}},
                   scene.handlers->footprints,
                   parts_of(scene, hits)};
  for (float& f : out.footprints) f /= float(scene.normalization.scale);
  return out;
}

namespace {

// Comments of PLY end with the line.
std::string on_one_line(std::string text) {
  for (char& c : text)
    if (uint8_t(c) < ' ') c = ' ';
  return text;
}

}  // namespace

std::string encode_handlers(const HandlerCloud& cloud) {
  PlyExtras extras{{}, {{"footprint", cloud.footprints}, {"part", cloud.parts.of}}};
  for (size_t k = 1; k < cloud.parts.names.size(); ++k)
    extras.comments.push_back(fmt::format("part {} {}", k, on_one_line(cloud.parts.names[k])));
  return encode_ply(cloud.points, extras);
}

}  // namespace cei3d
