// SPDX-License-Identifier: Apache-2.0
// What several stages make from the state: how the light turns in the training views, and hits of their
// pixels.
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

using Turns = std::shared_ptr<const LightTurns>;

// Axis of a turntable, unit.
Vec3f turntable_axis(const RunContext&);

// Rotations of the light in the training views. Null: the light is fixed to the object. A light that seemed
// to be fixed on the visual hull is tested again on the first trained surface.
Turns light_turns(const RunContext&, RunState&, const std::shared_ptr<const Surface>&, const ObjectHits&);

ObjectHits scene_hits(const RunContext&, const Scene&, const HitOptions&);

// Makes the hits of state.scene where the state has none.
void find_hits(const RunContext&, RunState&);

}  // namespace cei3d
