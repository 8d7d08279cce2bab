// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

struct ImageSize {
  int width = 0, height = 0;  // pixels
  bool operator==(const ImageSize&) const = default;
};

}  // namespace cei3d
