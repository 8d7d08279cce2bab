// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "engine/segment/sam.h"

namespace cei3d {
namespace {

constexpr int kFrame = 1024;
constexpr float kBackground = 0.5f;  // sRGB value where there is no object
constexpr float kMargin = 0.08f;     // around the object, as a share of its longer side

struct Box {
  int x0, y0, x1, y1;  // x1, y1: past the end
};

Box object_box(const Image& rgba) {
  Box b{rgba.width, rgba.height, 0, 0};
  for (int y = 0; y < rgba.height; ++y) {
    for (int x = 0; x < rgba.width; ++x) {
      if (rgba.at(x, y)[3] <= 0.5f) continue;
      b = {std::min(b.x0, x), std::min(b.y0, y), std::max(b.x1, x + 1), std::max(b.y1, y + 1)};
    }
  }
  if (b.x0 >= b.x1) return {0, 0, rgba.width, rgba.height};
  const int margin = int(std::ceil(kMargin * float(std::max(b.x1 - b.x0, b.y1 - b.y0))));
  return {std::max(b.x0 - margin, 0), std::max(b.y0 - margin, 0), std::min(b.x1 + margin, rgba.width),
          std::min(b.y1 + margin, rgba.height)};
}

// The image in sRGB over a uniform background.
Image displayed(const Image& rgba, const Box& b) {
  Image out(b.x1 - b.x0, b.y1 - b.y0, 3);
  for (int y = b.y0; y < b.y1; ++y) {
    for (int x = b.x0; x < b.x1; ++x) {
      const float* p = rgba.at(x, y);
      const float alpha = clamp(p[3], 0.0f, 1.0f);
      for (int c = 0; c < 3; ++c)
        out.at(x - b.x0, y - b.y0)[c] =
            255 * (alpha * srgb_from_linear(clamp(p[c], 0.0f, 1.0f)) + (1 - alpha) * kBackground);
    }
  }
  return out;
}

struct Taps {
  int first = 0;
  std::vector<float> weights;  // sum 1
};

// Linear interpolation when enlarging, a tent over the merged pixels when shrinking.
std::vector<Taps> tent(int from, int to) {
  const float step = float(from) / float(to), reach = std::max(step, 1.0f);
  std::vector<Taps> taps(to);
  for (int i = 0; i < to; ++i) {
    const float center = (float(i) + 0.5f) * step - 0.5f;
    const int a = std::max(int(std::ceil(center - reach)), 0);
    const int b = std::min(int(std::floor(center + reach)), from - 1);
    taps[i].first = a;
    float sum = 0;
    for (int k = a; k <= b; ++k) {
      taps[i].weights.push_back(std::max(1 - std::abs(float(k) - center) / reach, 0.0f));
      sum += taps[i].weights.back();
    }
    for (float& w : taps[i].weights) w /= sum;
  }
  return taps;
}

Image resize(const Image& in, int width, int height) {
  const std::vector<Taps> across = tent(in.width, width), down = tent(in.height, height);
  Image wide(width, in.height, in.channels), out(width, height, in.channels);
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t k = 0; k < across[x].weights.size(); ++k)
        for (int c = 0; c < in.channels; ++c)
          wide.at(x, y)[c] += across[x].weights[k] * in.at(across[x].first + int(k), y)[c];
  for (int y = 0; y < height; ++y)
    for (size_t k = 0; k < down[y].weights.size(); ++k)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < in.channels; ++c)
          out.at(x, y)[c] += down[y].weights[k] * wide.at(x, down[y].first + int(k))[c];
  return out;
}

}  // namespace

SamFrame sam_frame(const Image& rgba) {
  const Box b = object_box(rgba);
  const int width = b.x1 - b.x0, height = b.y1 - b.y0;
  SamFrame f;
  f.x0 = float(b.x0);
  f.y0 = float(b.y0);
  f.scale = float(kFrame) / float(std::max(width, height));
  f.rgb = resize(displayed(rgba, b), std::max(int(float(width) * f.scale + 0.5f), 1),
                 std::max(int(float(height) * f.scale + 0.5f), 1));
  return f;
}

}  // namespace cei3d
