// SPDX-License-Identifier: Apache-2.0
// What the session remembers of the last look that it packed for a page.
#pragma once

#include "engine/session/session.h"
#include "model/scene/appearance.h"

namespace cei3d {

// The appearance of the vertices. The next one mostly differs from it in few places.
struct Session::VertexLook {
  AppearanceKey key;
  Appearance look;
};

}  // namespace cei3d
