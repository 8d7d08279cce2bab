// SPDX-License-Identifier: Apache-2.0
// A scribble as the prompt for a part: where the part is, where it is not, and the color or pattern that it
// gets. [paper sec. 4.3, Algorithm 1]
#pragma once

#include <optional>

#include "core/image/image.h"

namespace cei3d {

struct PartScribble {
  Image positive, negative;  // 1 channel, of the scribble's size: 1 where a stroke is on, or beside, the part
  // Linear RGB. The largest rectangle that the strokes on the part fill; 1 x 1 if they are of one color.
  Image tile;
  int x0 = 0, y0 = 0;  // the tile's place in the scribble
  bool one_color() const { return tile.data.size() == 3; }
};

// rgba: sRGB, straight alpha; strokes are where alpha >= 0.5. negative_rgba: strokes beside the part; empty:
// none. negative_color: linear; strokes of `rgba` that have it are beside the part, too. Errors: no alpha
// channel, no stroke on the part. Usage error: sizes that differ.
PartScribble part_scribble(const Image& rgba, const Image& negative_rgba,
                           const std::optional<Vec3f>& negative_color);

}  // namespace cei3d
