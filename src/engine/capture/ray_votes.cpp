// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/ray_votes.h"

#include <algorithm>

#include "engine/capture/cell_votes.h"

namespace cei3d {

namespace {
constexpr Cells kSteps{192};  // along a ray
}

size_t RayVotes::allowed(double share) const {
  return std::max(size_t(1), size_t(share * double(voters_.size())));
}

RayVotes::Count RayVotes::count(Vec3d p, size_t enough) const {
  Count c;
  for (size_t v = 0; v < voters_.size() && c.background < enough; ++v) {
    const MaskSample s = sample_mask(voters_[v], p);
    c.seen += s != MaskSample::nothing;
    c.background += s == MaskSample::background;
  }
  return c;
}

// Of the few views that see a remote place, a quarter suffices to rule the object out.
size_t RayVotes::against(int x, int y, size_t least, size_t most) const {
  size_t fewest = most + 1;
  ray_meets(own_, x, y, kSteps, [&](Vec3d p) {
    const Count c = count(p, fewest);
    const bool few = 3 * c.seen < voters_.size();
    if (!few || 4 * c.background <= c.seen) fewest = std::min(fewest, c.background);
    return fewest <= least;
  });
  return std::max(fewest, least);
}

bool RayVotes::meets_object(int x, int y, size_t wrong) const {
  return ray_meets(own_, x, y, kSteps, [&](Vec3d p) {
    const Count c = count(p, wrong + 1);
    return c.background <= wrong && 3 * c.seen >= voters_.size();
  });
}

}  // namespace cei3d
