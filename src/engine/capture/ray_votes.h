// SPDX-License-Identifier: Apache-2.0
// What the masks of some views say about the ray of a pixel of another view.
#pragma once

#include <vector>

#include "core/math/camera.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

class RayVotes {
 public:
  // voters: without the view that asks, whose camera is `own`.
  RayVotes(std::vector<HullMask> voters, const Camera& own) : voters_(std::move(voters)), own_(own) {}

  // How many voters may be wrong: a share of them, and always one.
  size_t allowed(double share) const;

  // How many show background at the place of the ray where fewest do; `least` if these are as few, and one
  // more than `most` if they are more.
  size_t against(int x, int y, size_t least, size_t most) const;

  // Whether the ray meets a place that at least a third of the voters see and at most `wrong` take for
  // background.
  bool meets_object(int x, int y, size_t wrong) const;

 private:
  struct Count {
    size_t seen = 0, background = 0;
  };
  // Ends when `enough` see background.
  Count count(Vec3d p, size_t enough) const;

  std::vector<HullMask> voters_;
  Camera own_;
};

}  // namespace cei3d
