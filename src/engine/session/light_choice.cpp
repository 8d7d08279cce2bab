// SPDX-License-Identifier: Apache-2.0
#include "engine/session/light_choice.h"

#include "core/base/error.h"

namespace cei3d {

void choose_light(const LightChoice& choice, Scene&) {
  if (!choice.env.empty()) fail("Environment pictures are not read yet.");
}

}  // namespace cei3d
