// SPDX-License-Identifier: Apache-2.0
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
