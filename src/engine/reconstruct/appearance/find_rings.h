// SPDX-License-Identifier: Apache-2.0
// Turntables, by the cameras alone.
#pragma once

#include <span>
#include <vector>

#include "core/math/camera.h"
#include "model/light/light_turns.h"

namespace cei3d {

// The rings that the photographs were taken in: the object was laid down in another way between them, or the
// camera was moved up or down. cameras: in the order of the photographs. Empty: there are less than two, or
// many cameras are in none.
std::vector<CameraRing> find_rings(std::span<const Camera> cameras);

}  // namespace cei3d
