// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/math/tangents.h"
#include "engine/capture/check.h"
#include "engine/capture/normalize.h"

namespace cei3d {
namespace {

using Point = Vec2<double>;

class Panel {
 public:
  // Coordinates -reach..reach fill the panel, which starts at column x0.
  Panel(Image& image, int x0, int size, double reach) : image_(image), x0_(x0), size_(size), reach_(reach) {}

  void dot(Point p, double radius, Vec3f color) {
    const double cx = column(p.x), cy = row(p.y);
    for (int y = int(cy - radius) - 1; y <= int(cy + radius) + 1; ++y)
      for (int x = int(cx - radius) - 1; x <= int(cx + radius) + 1; ++x)
        blend(x, y, radius + 0.5 - std::hypot(x + 0.5 - cx, y + 0.5 - cy), color);
  }
  void line(Point a, Point b, Vec3f color) {
    const int steps = int(std::hypot(column(b.x) - column(a.x), row(b.y) - row(a.y))) * 2 + 1;
    for (int i = 0; i <= steps; ++i) {
      const double t = double(i) / steps;
      dot({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, 0.3, color);
    }
  }
  void circle(double radius, Vec3f color) {
    for (int i = 0; i < 720; ++i)
      line({radius * std::cos(i * kPi / 360), radius * std::sin(i * kPi / 360)},
           {radius * std::cos((i + 1) * kPi / 360), radius * std::sin((i + 1) * kPi / 360)}, color);
  }

 private:
  double column(double x) const { return (x / reach_ * 0.5 + 0.5) * size_; }
  double row(double y) const { return (0.5 - y / reach_ * 0.5) * size_; }
  void blend(int x, int y, double coverage, Vec3f color) {
    if (x < 0 || y < 0 || x >= size_ || y >= size_ || coverage <= 0) return;
    const float a = float(std::min(coverage, 1.0));
    float* p = image_.at(x0_ + x, y);
    for (int c = 0; c < 3; ++c) p[c] += a * (color[c] - p[c]);
  }
  Image& image_;
  int x0_, size_;
  double reach_;
};

Vec3f color_of(Split split) {
  return split == Split::train ? Vec3f{0.15f, 0.35f, 0.8f}
         : split == Split::val ? Vec3f{0.2f, 0.6f, 0.3f}
                               : Vec3f{0.9f, 0.5f, 0.1f};
}

}  // namespace

Image draw_cameras(const Capture& capture, const Normalization& normalization, int size) {
  const Vec3d up = normalize(capture.up);
  const auto [right, away] = tangents_of(up);
  double reach = 1;
  for (const View& v : capture.views)
    if (const double d = length(normalization.unit_from_capture(v.camera.center)); std::isfinite(d))
      reach = std::max(reach, d);

  Image image(2 * size, size, 3, 1.0f);
  Panel top(image, 0, size, reach * 1.1), side(image, size, size, reach * 1.1);
  for (Panel* panel : {&top, &side}) {
    panel->circle(1.0, {0.8f, 0.8f, 0.8f});
    panel->circle(kObjectRadius, {0.4f, 0.4f, 0.4f});
  }
  for (const View& v : capture.views) {
    const Vec3d p = normalization.unit_from_capture(v.camera.center),
                q = p + to_double(v.camera.forward()) * (0.12 * reach);
    if (!std::isfinite(dot(p, q))) continue;
    const Vec3f color = color_of(v.split);
    top.line({dot(p, right), dot(p, away)}, {dot(q, right), dot(q, away)}, color);
    side.line({dot(p, right), dot(p, up)}, {dot(q, right), dot(q, up)}, color);
    top.dot({dot(p, right), dot(p, away)}, 3, color);
    side.dot({dot(p, right), dot(p, up)}, 3, color);
  }
  for (int y = 0; y < size; ++y) std::fill_n(image.at(size, y), 3, 0.6f);
  return image;
}

}  // namespace cei3d
