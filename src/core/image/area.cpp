// SPDX-License-Identifier: Apache-2.0
#include "core/image/area.h"

#include <algorithm>

namespace cei3d {

Area dilated(const Area& area, int width, int height, int radius) {
  Area rows(area.size(), 0), out(area.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (area[size_t(y) * width + x])
        for (int k = std::max(0, x - radius); k <= std::min(width - 1, x + radius); ++k)
          rows[size_t(y) * width + k] = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (rows[size_t(y) * width + x])
        for (int k = std::max(0, y - radius); k <= std::min(height - 1, y + radius); ++k)
          out[size_t(k) * width + x] = 1;
  return out;
}

Area eroded(const Area& area, int width, int height, int radius) {
  Area rest(area.size());
  for (size_t i = 0; i < area.size(); ++i) rest[i] = !area[i];
  Area out = dilated(rest, width, height, radius);
  for (uint8_t& v : out) v = !v;
  return out;
}

Area opened(const Area& area, int width, int height, int radius) {
  return dilated(eroded(area, width, height, radius), width, height, radius);
}

Area parts_with(const Area& seeds, const Area& area, int width, int height) {
  Area out(area.size(), 0);
  std::vector<size_t> next;
  const auto visit = [&](size_t i) {
    if (area[i] && !out[i]) out[i] = 1, next.push_back(i);
  };
  for (size_t i = 0; i < seeds.size(); ++i)
    if (seeds[i]) visit(i);
  while (!next.empty()) {
    const size_t i = next.back(), w = size_t(width);
    next.pop_back();
    if (i % w > 0) visit(i - 1);
    if (i % w + 1 < w) visit(i + 1);
    if (i >= w) visit(i - w);
    if (i + w < w * size_t(height)) visit(i + w);
  }
  return out;
}

Image shown_in(const Image& image, const Area& area, float background) {
  Image out = image;
  for (size_t i = 0; i < area.size(); ++i)
    if (!area[i]) std::fill_n(&out.data[i * size_t(image.channels)], image.channels, background);
  return out;
}

void add_to(Area& area, const Area& more) {
  for (size_t i = 0; i < area.size(); ++i) area[i] |= more[i];
}

size_t pixels_in(const Area& area) { return size_t(std::count(area.begin(), area.end(), uint8_t(1))); }

}  // namespace cei3d
