// SPDX-License-Identifier: Apache-2.0
// Decibels in reports. The PSNR of identical images is infinite, which JSON cannot express: it becomes a
// word.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/base/json.h"

namespace cei3d {

inline Json decibels(double v) { return std::isfinite(v) ? Json(v) : Json("infinite"); }
inline std::string decibels_text(double v) {
  return std::isfinite(v) ? fmt::format("{:.2f}", v) : "identical";
}

}  // namespace cei3d
