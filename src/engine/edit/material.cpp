// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/material.h"

#include <cmath>

#include "core/base/error.h"
#include "model/geometry/mesh/areas.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

void check_share(const std::optional<float>& value, const char* name) {
  if (value && !(*value >= 0 && *value <= 1))
    fail_usage("{} {} is not in the range from 0 to 1.", name, *value);
}

void check_request(const MaterialRequest& r) {
  if (r.change.empty() && !r.color)
    fail_usage("Nothing to change: give a roughness, a specular, a metalness or a color.");
  check_change(r.change);
  for (int c = 0; r.color && c < 3; ++c) check_share((*r.color)[c], "A channel of the color,");
}

// Vertices of the present surface in the layer's region, with their areas.
struct Inside {
  std::vector<Hit> hits;
  std::vector<double> areas;
  double area = 0;

  Inside(const Scene& scene, const EditLayer& layer) {
    const Mesh& mesh = scene.surface->mesh();
    const std::vector<Hit> all = vertex_hits(mesh);
    const std::vector<uint8_t> inside = inside_layer(scene, layer, all);
    const std::vector<double> weight = vertex_areas(mesh);
    for (size_t v = 0; v < all.size(); ++v) {
      if (!inside[v] || weight[v] <= 0) continue;
      hits.push_back(all[v]);
      areas.push_back(weight[v]);
      area += weight[v];
    }
  }
};

Vec3f mean_color(const Device& device, const Scene& scene, const Inside& inside) {
  const std::vector<Vec3f> color = appearance_at(device, scene, inside.hits).albedo;
  Vec3d sum{0, 0, 0};
  for (size_t i = 0; i < color.size(); ++i) sum += to_double(color[i]) * inside.areas[i];
  return to_float(sum / inside.area);
}

}  // namespace

void check_change(const MaterialChange& c) {
  check_share(c.roughness, "Roughness");
  check_share(c.specular, "Specular");
  check_share(c.metalness, "Metalness");
  check_share(c.blend, "Blend");
  if (c.roughness && c.roughness_scale) fail_usage("Give a roughness or a scale of the roughness, not both.");
  if (c.roughness_scale && !(*c.roughness_scale >= 0 && std::isfinite(*c.roughness_scale)))
    fail_usage("Roughness scale {} is not a number from 0 up.", *c.roughness_scale);
}

Vec3f mean_color_inside(const Device& device, const Scene& scene, const EditLayer& layer) {
  const Inside inside(scene, layer);
  if (inside.hits.empty()) fail("The part is nowhere on the surface as it is now; was it removed?");
  return mean_color(device, scene, inside);
}

MaterialResult change_material(const Device& device, const Scene& scene, const MaterialRequest& request) {
  check_request(request);
  MaterialResult result;
  EditLayer& layer = result.layer;
  layer.id = request.id;
  layer.material = request.change;
  if (request.part.empty()) {
    layer.everywhere = true;
    layer.shape_version = scene.shape_versions.empty() ? 0 : int(scene.shape_versions.size()) - 1;
  } else {
    const EditLayer& part = part_layer(scene, request.part);
    layer.everywhere = part.everywhere;
    layer.region = part.region;
    layer.shape_version = part.shape_version;
  }
  const Inside inside(scene, layer);
  if (inside.hits.empty())
    fail("Part '{}' is nowhere on the surface as it is now; was it removed?", request.part);
  result.report.points = inside.hits.size();
  if (request.color) {
    layer.tint = Tint{*request.color, request.keep_texture, {1, 1, 1}, request.change.blend};
    if (request.keep_texture) layer.tint->mean = mean_color(device, scene, inside);
    result.report.mean = layer.tint->mean;
  }
  return result;
}

}  // namespace cei3d
