// SPDX-License-Identifier: Apache-2.0
// Whether the light stands still against the object, or turns with the camera.
#pragma once

#include "core/math/camera.h"
#include "engine/reconstruct/appearance/appearance_stage.h"

namespace cei3d {

struct MotionSearch {
  uint64_t seed = 1;
  // Whether to search for materials of the vertices where one material cannot decide. Needs a surface with
  // the object's details.
  bool several_materials = true;
};
// The motion that explains held-out views best, after a linear separation of the other views. A light that
// stands still wins unless another motion leaves a much smaller residual. input: its samples not turned.
// views: #samples, index of the camera. cameras: of the training views; the first is the reference. axis: of
// a turntable, unit, where the cameras are not in rings (find_rings.h).
LightFrame find_light_frame(const AppearanceInput& input, std::span<const uint16_t> views,
                            std::span<const Camera> cameras, Vec3f axis, const MotionSearch&, Progress&);

// The frame of a light with this motion. Its reference is the first camera.
LightFrame light_frame(LightMotion, std::span<const Camera> cameras, Vec3f axis);

// Null where the light stands still.
std::shared_ptr<const LightTurns> turns_of(const LightFrame&, std::span<const Camera> cameras);

}  // namespace cei3d
