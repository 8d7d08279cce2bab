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

// camera: unit frame. A pixel is inside if one of its samples hits surface that the layer contains or
// reshaped, or hits another place than before. For an edit that is not local (light, the whole object) the
// whole object is inside. before: the scene below the last layer of `after`.
ChangeReport compare_views(const Device&, RenderCache&, const Scene& before, const Scene& after,
                           const Camera& camera, int samples);

}  // namespace cei3d
