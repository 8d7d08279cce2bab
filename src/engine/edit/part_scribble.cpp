// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_scribble.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/quantile.h"

namespace cei3d {
namespace {

constexpr float kAlike = 0.06f;          // largest difference of a channel, sRGB, between pixels of one color
constexpr double kOneColorShare = 0.95;  // share of the pixels that have the color of a stroke of one color

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  int64_t area() const { return int64_t(width) * height; }
};

bool alike(Vec3f a, Vec3f b) { return max(max(abs(a.x - b.x), abs(a.y - b.y)), abs(a.z - b.z)) <= kAlike; }

bool is_drawn(const Image& rgba, size_t pixel) { return rgba.data[4 * pixel + 3] >= 0.5f; }

Vec3f color_at(const Image& rgba, size_t pixel) {
  return {rgba.data[4 * pixel], rgba.data[4 * pixel + 1], rgba.data[4 * pixel + 2]};
}

// The largest rectangle that ends at the bottom row of columns with these heights. Columns wait on a stack
// until a lower one ends their rectangles.
Rectangle largest_below(const std::vector<int>& heights, int bottom) {
  Rectangle best;
  std::vector<int> open;
  for (int x = 0; x <= int(heights.size()); ++x) {
    const int height = x < int(heights.size()) ? heights[size_t(x)] : 0;
    while (!open.empty() && heights[size_t(open.back())] >= height) {
      const int top = heights[size_t(open.back())];
      open.pop_back();
      const int left = open.empty() ? 0 : open.back() + 1;
      const Rectangle r{left, bottom + 1 - top, x - left, top};
      if (r.area() > best.area()) best = r;
    }
    open.push_back(x);
  }
  return best;
}

Rectangle largest_rectangle(const Image& mask) {
  Rectangle best;
  std::vector<int> heights(size_t(mask.width), 0);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) heights[size_t(x)] = *mask.at(x, y) > 0 ? heights[size_t(x)] + 1 : 0;
    const Rectangle r = largest_below(heights, y);
    if (r.area() > best.area()) best = r;
  }
  return best;
}

// sRGB; none: more than one color.
std::optional<Vec3f> single_color(const Image& rgba, const Image& mask) {
  std::vector<float> channels[3];
  for (size_t i = 0; i < mask.data.size(); ++i)
    for (int c = 0; mask.data[i] > 0 && c < 3; ++c) channels[c].push_back(rgba.data[4 * i + size_t(c)]);
  const Vec3f middle{median(channels[0]), median(channels[1]), median(channels[2])};
  size_t same = 0;
  for (size_t i = 0; i < channels[0].size(); ++i)
    same += alike({channels[0][i], channels[1][i], channels[2][i]}, middle);
  if (double(same) < kOneColorShare * double(channels[0].size())) return std::nullopt;
  return middle;
}

void put_tile(const Image& rgba, PartScribble& s) {
  Rectangle r{0, 0, 1, 1};
  const std::optional<Vec3f> single = single_color(rgba, s.positive);
  if (!single) r = largest_rectangle(s.positive);
  s.tile = Image(r.width, r.height, 3);
  s.x0 = r.x, s.y0 = r.y;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const Vec3f color = linear_from_srgb(single ? *single : rgba.rgb(r.x + x, r.y + y));
      for (int c = 0; c < 3; ++c) s.tile.at(x, y)[c] = color[c];
    }
}

void check(const Image& rgba, const Image& negative_rgba) {
  for (const Image* image : {&rgba, &negative_rgba})
    if (!image->empty() && image->channels != 4)
      fail(
          "The scribble has no alpha channel; save it as RGBA, opaque where it draws and transparent "
          "elsewhere.");
  if (!negative_rgba.empty() && (negative_rgba.width != rgba.width || negative_rgba.height != rgba.height))
    fail_usage(
        "The scribble is {}x{} pixels, the negative one {}x{}; draw both on images of the view's size.",
        rgba.width, rgba.height, negative_rgba.width, negative_rgba.height);
}

}  // namespace

PartScribble part_scribble(const Image& rgba, const Image& negative_rgba,
                           const std::optional<Vec3f>& negative_color) {
  check(rgba, negative_rgba);
  PartScribble s;
  s.positive = s.negative = Image(rgba.width, rgba.height, 1);
  const Vec3f beside = negative_color ? srgb_from_linear(*negative_color) : Vec3f{};
  size_t drawn = 0, positive = 0;
  for (size_t i = 0; i < s.positive.data.size(); ++i) {
    if (!negative_rgba.empty() && is_drawn(negative_rgba, i)) s.negative.data[i] = 1;
    if (!is_drawn(rgba, i)) continue;
    ++drawn;
    const bool is_beside = negative_color && alike(color_at(rgba, i), beside);
    (is_beside ? s.negative : s.positive).data[i] = 1;
    positive += !is_beside;
  }
  if (drawn == 0) fail("Nothing in the scribble is opaque: there is no stroke.");
  if (positive == 0)
    fail("All strokes of the scribble have the negative color; draw one on the part in another.");
  put_tile(rgba, s);
  return s;
}

}  // namespace cei3d
