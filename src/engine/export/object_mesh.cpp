// SPDX-License-Identifier: Apache-2.0
#include "engine/export/object_mesh.h"

#include "core/base/error.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

std::vector<Vec3f> in_capture_frame(std::vector<Vec3f> points, const Normalization& n) {
  for (Vec3f& p : points) p = to_float(n.input_from_unit(to_double(p)));
  return points;
}

// Drops vertices without triangles, left by removed parts.
Mesh compact(const Mesh& mesh) {
  constexpr uint32_t kUnused = ~0u;
  std::vector<uint32_t> id(mesh.positions.size(), kUnused);
  Mesh out;
  out.triangles = mesh.triangles;
  for (auto& t : out.triangles)
    for (uint32_t& v : t) {
      if (id[v] == kUnused) {
        id[v] = uint32_t(out.positions.size());
        out.positions.push_back(mesh.positions[v]);
        out.normals.push_back(mesh.normals[v]);
        out.colors.push_back(mesh.colors[v]);
      }
      v = id[v];
    }
  return out;
}

// That of two corners of a triangle counts, else that of the first.
std::vector<uint32_t> by_triangle(const Mesh& mesh, const std::vector<uint32_t>& of_vertex) {
  std::vector<uint32_t> out;
  for (const auto& t : mesh.triangles) {
    const uint32_t a = of_vertex[t[0]], b = of_vertex[t[1]], c = of_vertex[t[2]];
    out.push_back(b == c ? b : a);
  }
  return out;
}

// Without materials that no triangle has.
MeshMaterials used(const MeshMaterials& all) {
  constexpr uint32_t kUnused = ~0u;
  std::vector<uint32_t> id(all.list.size(), kUnused);
  MeshMaterials out;
  for (const uint32_t m : all.of_triangle) {
    if (id[m] == kUnused) {
      id[m] = uint32_t(out.list.size());
      out.list.push_back(all.list[m]);
    }
    out.of_triangle.push_back(id[m]);
  }
  return out;
}

}  // namespace

ColoredMesh colored_mesh(const Device& device, const Scene& scene) {
  if (!scene.surface || !scene.albedo) fail("The object has no surface to export; reconstruct it again.");
  Mesh mesh = scene.surface->mesh();
  Appearance look = appearance_at(device, scene, vertex_hits(mesh));
  mesh.colors = std::move(look.albedo);
  const MeshMaterials materials = used({std::move(look.materials), by_triangle(mesh, look.material)});
  if (!scene.poses.empty()) mesh = compact(mesh);
  mesh.positions = in_capture_frame(std::move(mesh.positions), scene.normalization);
  return {std::move(mesh), materials};
}

Mesh handler_point_cloud(const Scene& scene) {
  if (!scene.handlers) fail("The object has no handler points; reconstruct it again.");
  Mesh points;
  points.positions = in_capture_frame(scene.handlers->positions, scene.normalization);
  points.normals = scene.handlers->normals;
  return points;
}

}  // namespace cei3d
