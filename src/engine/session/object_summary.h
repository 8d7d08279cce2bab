// SPDX-License-Identifier: Apache-2.0
// Fills in what `info` and the editor say about an object.
#pragma once

#include "core/compute/device.h"
#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// Summary of the object as reconstructed. Without a surface it has only the mean material.
ObjectSummary summary_of(const Device&, const Scene&);

}  // namespace cei3d
