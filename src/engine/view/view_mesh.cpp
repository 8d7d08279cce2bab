// SPDX-License-Identifier: Apache-2.0
#include "engine/view/view_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/math/axis_box.h"
#include "engine/view/pack.h"
#include "engine/view/quantize.h"
#include "engine/view/visibility_harmonics.h"
#include "model/geometry/mesh/simplify.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

constexpr size_t kCoarseFaces = 30'000;
constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

// The vertices that the triangles use, in their order.
ViewMesh compacted(const std::vector<std::array<uint32_t, 3>>& triangles, size_t vertices) {
  ViewMesh out;
  std::vector<uint32_t> id(vertices, kUnused);
  for (const auto& t : triangles)
    for (const uint32_t v : t) id[v] = 0;
  for (uint32_t v = 0; v < vertices; ++v)
    if (id[v] != kUnused) {
      id[v] = uint32_t(out.vertices.size());
      out.vertices.push_back(v);
    }
  for (const auto& t : triangles) out.triangles.push_back({id[t[0]], id[t[1]], id[t[2]]});
  return out;
}

std::vector<uint16_t> quantized(const std::vector<Vec3d>& points, const AxisBoxOf<double>& box) {
  std::vector<uint16_t> out;
  const Vec3d size = box.size();
  for (const Vec3d& p : points) {
    for (int c = 0; c < 3; ++c)
      out.push_back(unorm16(size[c] > 0 ? float((p[c] - box.min[c]) / size[c]) : 0));
    out.push_back(0);
  }
  return out;
}

std::vector<int16_t> octahedral(const std::vector<Vec3f>& normals, const ViewMesh& view) {
  std::vector<int16_t> out;
  for (const uint32_t v : view.vertices) {
    const Vec2f p = octahedron_from_direction(normals[v]);
    out.push_back(snorm16(p.x));
    out.push_back(snorm16(p.y));
  }
  return out;
}

std::vector<uint32_t> indices_of(const std::vector<std::array<uint32_t, 3>>& triangles) {
  std::vector<uint32_t> out;
  for (const auto& t : triangles) out.insert(out.end(), t.begin(), t.end());
  return out;
}

std::vector<VisibilityTerms> visibility_of(const Surface& surface, const ViewMesh& view) {
  const std::vector<VisibilityTerms> terms = visibility_harmonics(surface);
  std::vector<VisibilityTerms> out;
  for (const uint32_t v : view.vertices) out.push_back(terms[v]);
  return out;
}

}  // namespace

ViewMesh view_mesh(const Scene& scene, size_t faces) {
  if (!scene.surface || scene.surface->mesh().triangles.empty())
    fail("The object has no surface to show; reconstruct it again.");
  const Mesh& mesh = scene.surface->mesh();
  if (faces == 0) return compacted(mesh.triangles, mesh.positions.size());
  const Simplified simple = simplified(mesh, faces);
  ViewMesh out = compacted(simple.mesh.triangles, simple.vertex.size());
  for (uint32_t& v : out.vertices) v = simple.vertex[v];
  out.error = double(simple.error) / scene.normalization.scale;
  return out;
}

std::string view_shape(const Scene& scene, const ViewMesh& view) {
  const Mesh& mesh = scene.surface->mesh();
  std::vector<Vec3d> points;
  for (const uint32_t v : view.vertices)
    points.push_back(scene.normalization.capture_from_unit(to_double(mesh.positions[v])));
  const AxisBoxOf<double> box = box_of(points);
  const Vec3d size = box.size();
  Pack pack("shape");
  pack["min"] = {box.min.x, box.min.y, box.min.z};
  pack["size"] = {size.x, size.y, size.z};
  pack.add("positions", quantized(points, box), 4);
  pack.add("normals", octahedral(mesh.normals, view), 2);
  add_visibility(visibility_of(*scene.surface, view), pack);
  pack.add("triangles", indices_of(view.triangles), 3);
  return pack.bytes();
}

std::string view_coarse(const Scene& scene, const ViewMesh& view) {
  Mesh mesh{{}, {}, {}, view.triangles};
  for (const uint32_t v : view.vertices) mesh.positions.push_back(scene.surface->mesh().positions[v]);
  Simplified simple = simplified(mesh, kCoarseFaces);
  for (auto& t : simple.mesh.triangles)
    for (uint32_t& v : t) v = simple.vertex[v];
  Pack pack("coarse");
  pack.add("triangles", indices_of(simple.mesh.triangles), 3);
  return pack.bytes();
}

std::string view_look(const Device& device, const Scene& scene, const ViewMesh& view) {
  return view_look(scene, view, appearance_at(device, scene, vertex_hits(scene.surface->mesh())));
}

std::string view_look(const Scene& scene, const ViewMesh& view, const Appearance& look) {
  Pack pack("look");
  const PartsOfHits parts = parts_of(scene, vertex_hits(scene.surface->mesh()));
  pack["parts"] = parts.names;
  std::vector<uint16_t> albedo;
  std::vector<uint8_t> material;
  for (const uint32_t v : view.vertices) {
    const Material& m = look.material[v];
    for (int c = 0; c < 3; ++c) albedo.push_back(unorm16(std::sqrt(max(look.albedo[v][c], 0.0f))));
    albedo.push_back(look.unlit.empty() ? uint16_t(0) : unorm16(look.unlit[v]));
    for (const float x : {m.roughness, m.specular, m.metalness}) material.push_back(unorm8(x));
    material.push_back(parts.of[v]);
  }
  pack.add("albedo", albedo, 4);
  pack.add("material", material, 4);
  return pack.bytes();
}

std::string view_vertex_light(const VertexLight& light, const ViewMesh& view) {
  std::vector<uint8_t> visibility;
  std::vector<uint32_t> bounce;
  for (const uint32_t v : view.vertices) {
    for (int c = 0; c < 3; ++c) visibility.push_back(unorm8(light.visibility[v][c]));
    visibility.push_back(255);
    bounce.push_back(shared_exponent(light.bounce[v]));
  }
  Pack pack("vertex_light");
  pack.add("visibility", visibility, 4);
  pack.add("bounce", bounce, 1);
  return pack.bytes();
}

}  // namespace cei3d
