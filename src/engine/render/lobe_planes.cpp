// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lobe_planes.h"

#include "core/compute/linear.h"

namespace cei3d {

std::vector<float> lobe_planes(const SgMixture& light) {
  const auto padded = size_t(padded_to_panels(int(light.lobes.size())));
  std::vector<float> planes(7 * padded, 0);
  for (size_t k = 0; k < light.lobes.size(); ++k) {
    const SgLobe& l = light.lobes[k];
    const float row[] = {l.axis.x, l.axis.y, l.axis.z, clamp(l.lambda, kBroadestLobe, kSharpestLobe),
                         l.mu.x,   l.mu.y,   l.mu.z};
    for (size_t j = 0; j < 7; ++j) planes[j * padded + k] = row[j];
  }
  return planes;
}

}  // namespace cei3d
