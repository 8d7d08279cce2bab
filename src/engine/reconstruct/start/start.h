// SPDX-License-Identifier: Apache-2.0
// Shapes that descent can start from.
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/geometry/geometry_stage.h"

namespace cei3d {

enum class Start {
  hull,    // what the masks leave
  carved,  // ... and the colours (engine/reconstruct/start/carve.h)
  stereo,  // ... and depths by correlation (engine/reconstruct/start/stereo.h)
};

// Error: empty hull.
StartShape start_shape(const PixelStore&, Start, uint64_t seed);

// The one from which a short training explains the pictures best: no rule tells beforehand. Carving opens
// what the visual hull cannot (the inside of a shovel) but is deceived by mirror images (a metal body is
// hollowed out where the reflections seem to be); stereo finds courtyards of brick but needs texture.
StartShape choose_start(const Device&, const PixelStore&, const GeometryOptions&, uint64_t seed, Progress&);

}  // namespace cei3d
