// SPDX-License-Identifier: Apache-2.0
// What an edit changed in one view: pixels inside its region, and pixels outside, of which there must be
// none.
#pragma once

#include "engine/render/render.h"

namespace cei3d {

class RenderCache;  // engine/render/render_cache.h

struct ChangeReport {
  size_t pixels_inside = 0;    // pixels that the edit may change: see compare_views()
  size_t pixels_changed = 0;   // pixels that changed, anywhere
  size_t changed_outside = 0;  // must be 0
  Frame before, after;
};

// camera: unit-sphere frame. A pixel is inside when one of its samples meets matter that the layer contains
// or that it reshaped, or matter elsewhere than before. An edit that is not local (light, the whole object)
// has the whole object inside. before: the scene below the last layer of `after`.
ChangeReport compare_views(const Device&, RenderCache&, const Scene& before, const Scene& after,
                           const Camera& camera, int samples);

}  // namespace cei3d
