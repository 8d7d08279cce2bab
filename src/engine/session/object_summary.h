// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/compute/device.h"
#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// Of the object as reconstructed. A scene without surface has the mean material only.
ObjectSummary summary_of(const Device&, const Scene&);

}  // namespace cei3d
