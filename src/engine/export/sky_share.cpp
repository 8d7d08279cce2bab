// SPDX-License-Identifier: Apache-2.0
#include "engine/export/sky_share.h"

#include "core/base/parallel.h"

namespace cei3d {

std::vector<float> sky_shares(const Surface& surface) {
  const std::vector<Vec3f>& normals = surface.mesh().normals;
  const std::vector<Vec3f>& sky = sky_directions();
  std::vector<float> out(normals.size());
  parallel_ranges(int(normals.size()), 1024, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      float free = 0, all = 0;
      for (int k = 0; k < kSkyDirections; ++k) {
        const float cosine = max(dot(sky[size_t(k)], normals[size_t(v)]), 0.0f);
        all += cosine;
        if (surface.sees(uint32_t(v), k)) free += cosine;
      }
      out[size_t(v)] = all > 0 ? free / all : 1;
    }
  });
  return out;
}

}  // namespace cei3d
