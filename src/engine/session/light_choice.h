// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// The scene under the light that is asked for. Errors: unreadable environment picture.
void choose_light(const LightChoice&, Scene&);

}  // namespace cei3d
