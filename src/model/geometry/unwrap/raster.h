// SPDX-License-Identifier: Apache-2.0
// Rasterizes triangles of an atlas.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/vec2.h"

namespace cei3d {

// Calls use(x, y, b1, b2) for the texels of a width x height image whose centers (at +0.5) lie in a triangle
// or on its rim, with their barycentric coordinates. Corners in texels. A triangle without area has none.
template <class Use>
void for_each_texel(Vec2f a, Vec2f b, Vec2f c, int width, int height, const Use& use) {
  const Vec2d e{double(b.x) - a.x, double(b.y) - a.y}, g{double(c.x) - a.x, double(c.y) - a.y};
  if (signed_area(e, g) == 0) return;
  const auto first = [](float low) { return std::max(0, int(std::ceil(low - 0.5f))); };
  const auto end = [](float high, int size) { return std::min(size, int(std::floor(high - 0.5f)) + 1); };
  const int x0 = first(std::min({a.x, b.x, c.x})), x1 = end(std::max({a.x, b.x, c.x}), width);
  const int y0 = first(std::min({a.y, b.y, c.y})), y1 = end(std::max({a.y, b.y, c.y}), height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const auto [b1, b2] = barycentrics_in(e, g, Vec2d{x + 0.5 - a.x, y + 0.5 - a.y});
      if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) use(x, y, float(b1), float(b2));
    }
}

// Calls use(x, y) for those texels that lie in the triangle for sure: others are nearer to an edge than
// rounding errors of the corners.
template <class Use>
void for_each_inner_texel(Vec2f a, Vec2f b, Vec2f c, int width, int height, const Use& use) {
  constexpr float kFromEdge = 0.02f;  // texels
  const float area = std::abs(signed_area(b - a, c - a));
  const auto min_share = [&](Vec2f p, Vec2f q) {
    return kFromEdge * std::hypot(q.x - p.x, q.y - p.y) / area;
  };
  const float min_a = min_share(b, c), min_b = min_share(a, c), min_c = min_share(a, b);
  for_each_texel(a, b, c, width, height, [&](int x, int y, float b1, float b2) {
    if (1 - b1 - b2 >= min_a && b1 >= min_b && b2 >= min_c) use(x, y);
  });
}

}  // namespace cei3d
