// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_vertices.h"

#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {

std::vector<uint8_t> part_vertices(const Scene& scene, const std::string& part) {
  return inside_layer(scene, part_layer(scene, part), vertex_hits(scene.surface->mesh()));
}

}  // namespace cei3d
