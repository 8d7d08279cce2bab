// SPDX-License-Identifier: Apache-2.0
#include "engine/export/fill_empty.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

struct Level {
  Image image;
  Area known;
};

bool complete(const Level& l) { return std::find(l.known.begin(), l.known.end(), 0) == l.known.end(); }

Level halved(const Image& image, const Area& known) {
  Level out{Image((image.width + 1) / 2, (image.height + 1) / 2, image.channels), {}};
  out.known.assign(size_t(out.image.width) * out.image.height, 0);
  parallel_ranges(out.image.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < out.image.width; ++x) {
        int n = 0;
        float* sum = out.image.at(x, y);
        for (int k = 0; k < 4; ++k) {
          const int u = 2 * x + k % 2, v = 2 * y + k / 2;
          if (u >= image.width || v >= image.height || !known[size_t(v) * image.width + u]) continue;
          ++n;
          for (int c = 0; c < image.channels; ++c) sum[c] += image.at(u, v)[c];
        }
        for (int c = 0; c < image.channels && n > 0; ++c) sum[c] /= float(n);
        out.known[size_t(y) * out.image.width + x] = n > 0;
      }
  });
  return out;
}

// A texel takes what the 2 x 2 texels around it know, of the level above.
void fill_from(const Image& coarse, Image& image, const Area& known) {
  parallel_ranges(image.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x)
        if (!known[size_t(y) * image.width + x])
          std::copy_n(coarse.at(x / 2, y / 2), image.channels, image.at(x, y));
  });
}

}  // namespace

void fill_empty(Image& image, const Area& known) {
  if (image.empty() || std::find(known.begin(), known.end(), 1) == known.end()) return;
  std::vector<Level> levels{halved(image, known)};
  while (!complete(levels.back())) levels.push_back(halved(levels.back().image, levels.back().known));
  for (size_t l = levels.size() - 1; l > 0; --l)
    fill_from(levels[l].image, levels[l - 1].image, levels[l - 1].known);
  fill_from(levels[0].image, image, known);
}

}  // namespace cei3d
