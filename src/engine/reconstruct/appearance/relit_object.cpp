// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/relit_object.h"

#include <string>

#include "model/geometry/shape/vec_tensors.h"
#include "model/scene/stored.h"

namespace cei3d {
namespace {

const std::string kAlbedo = "relit_albedo", kMaterials = "relit_materials", kLight = "relit_light";

std::vector<Vec3f> rows_of(const std::vector<Material>& materials) {
  std::vector<Vec3f> rows;
  for (const Material& m : materials) rows.push_back({m.roughness, m.specular, m.metalness});
  return rows;
}
std::vector<Material> materials_of(const std::vector<Vec3f>& rows) {
  std::vector<Material> materials;
  for (const Vec3f r : rows) materials.push_back({r.x, r.y, r.z});
  return materials;
}

}  // namespace

std::unique_ptr<Lighting> RelitObject::lighting(const Device& device,
                                                const std::shared_ptr<const Surface>& surface,
                                                const Transport& transport, const LightTurns* turns) const {
  return std::make_unique<Lighting>(device, surface, light,
                                    turned_vertex_lights(transport, light, {albedo, materials}, turns));
}

void RelitObject::save(Tensors& out) const {
  out[kAlbedo] = tensor_of(albedo);
  out[kMaterials] = tensor_of(rows_of(materials));
  out[kLight] = tensor_of(light);
}

RelitObject RelitObject::load(const Tensors& in, size_t vertices, size_t lobes) {
  return {vectors_from(in, kAlbedo, int64_t(vertices)),
          materials_of(vectors_from(in, kMaterials, int64_t(vertices))),
          light_from(in, kLight, int64_t(lobes))};
}

bool RelitObject::is_in(const Tensors& in) { return in.contains(kAlbedo); }

}  // namespace cei3d
