// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/area.h"

#include <algorithm>

namespace cei3d {

Area dilated(const Area& area, int width, int height, int radius) {
  Area out(area.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!area[size_t(y) * width + x]) continue;
      const int x0 = std::max(x - radius, 0), x1 = std::min(x + radius, width - 1);
      for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
        std::fill(&out[size_t(v) * width + x0], &out[size_t(v) * width + x1] + 1, uint8_t(1));
    }
  return out;
}

Image shown_in(const Image& image, const Area& area, float background) {
  Image out = image;
  for (size_t i = 0; i < area.size(); ++i)
    if (!area[i]) std::fill_n(&out.data[i * size_t(image.channels)], image.channels, background);
  return out;
}

size_t pixels_in(const Area& area) { return size_t(std::count(area.begin(), area.end(), uint8_t(1))); }

}  // namespace cei3d
