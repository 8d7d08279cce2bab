// SPDX-License-Identifier: Apache-2.0
// The background of photographs on a turntable: what stays the same while the object turns.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/progress.h"
#include "core/image/area.h"

namespace cei3d {

struct StillPixels {
  int width = 0, height = 0;  // of the photographs
  int reduction = 1;          // the area is smaller by this factor
  Area area;                  // 1: shows the same in nearly all photographs
};

// Errors: photographs of several sizes, unreadable ones, interrupted.
StillPixels still_pixels(const std::vector<std::filesystem::path>& photos, const Progress&);

}  // namespace cei3d
