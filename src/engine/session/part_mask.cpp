// SPDX-License-Identifier: Apache-2.0
#include "engine/session/part_mask.h"

#include "model/scene/parts.h"

namespace cei3d {

Image part_mask(const Scene& scene, const EditLayer& part, const GBuffer& g) {
  const std::vector<uint8_t> inside = inside_layer(scene, part, g.hits);
  Image mask(g.width, g.height, 1);
  for (size_t p = 0; p < mask.data.size(); ++p) {
    int hits = 0;
    for (uint32_t i = g.pixel_start[p]; i < g.pixel_start[p + 1]; ++i) hits += inside[i];
    mask.data[p] = float(hits) / float(g.samples_of(p));
  }
  return mask;
}

}  // namespace cei3d
