// SPDX-License-Identifier: Apache-2.0
// Tests only: a ball that stands on a table, photographed from above all around, with points on both and on
// the walls of the room.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"
#include "engine/photos/photo_segmenter.h"

namespace cei3d {

struct TestTable {
  Vec3d ball{0, 0, 0.5};
  double radius = 0.5;
  std::vector<View> views;
  std::vector<Vec3d> on_ball, on_table, on_wall;
};

inline bool sees_ball(const TestTable& t, const Camera& c, Vec2d pixel) {
  const Ray ray = c.ray(pixel.x, pixel.y);
  const Vec3d to = t.ball - to_double(ray.origin);
  return length(cross(to, to_double(ray.direction))) < t.radius;
}

inline Camera table_camera(const TestTable& t, double azimuth, double elevation) {
  Camera c;
  c.width = 120, c.height = 90, c.fx = c.fy = 130, c.cx = 60, c.cy = 45;
  const Vec3d away{std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                   std::sin(elevation)};
  c.center = t.ball + 3.0 * away;
  c.world_from_cam = upright_rotation(-away, {0, 0, 1});
  return c;
}

inline void add_sightings(TestTable& t) {
  for (View& v : t.views) {
    std::vector<Sighting> seen;
    const auto add = [&](const std::vector<Vec3d>& points, bool of_ball) {
      for (const Vec3d& p : points) {
        const Vec3d at = v.camera.project(p);
        if (at.z <= 0 || at.x < 0 || at.y < 0 || at.x >= v.camera.width || at.y >= v.camera.height) continue;
        const bool front = dot(p - t.ball, v.camera.center - p) > 0;
        if (of_ball ? front : !sees_ball(t, v.camera, {at.x, at.y})) seen.push_back({p, {at.x, at.y}});
      }
    };
    add(t.on_ball, true), add(t.on_table, false), add(t.on_wall, false);
    v.sightings = std::make_shared<std::vector<Sighting>>(seen);
  }
}

inline TestTable test_table(int views = 24) {
  TestTable t;
  for (int i = 0; i < 400; ++i) {
    const Vec3d p = t.ball + t.radius * to_double(fibonacci_direction(i, 400));
    if (p.z > 0.05) t.on_ball.push_back(p);
  }
  Rng rng(7, 0, 0);
  const auto random = [&] { return 2.0 * rng.uniform() - 1; };
  for (int i = 0; i < 300; ++i) t.on_table.push_back({2 * random(), 2 * random(), 0.003 * random()});
  for (int i = 0; i < 100; ++i) t.on_wall.push_back({9 * random(), 9.0, 3 * (1 + random())});
  for (int i = 0; i < views; ++i) {
    View v;
    v.name = "photo_" + std::to_string(i);
    v.camera = table_camera(t, 2 * kPi * i / views, i % 2 ? 0.4 : 0.8);
    t.views.push_back(v);
  }
  add_sightings(t);
  return t;
}

// Sees the ball as it is, and in `wrong` photographs, as long as no box is given, everything.
class TrueSegmenter final : public PhotoSegmenter {
 public:
  explicit TrueSegmenter(const TestTable& t) : table_(t) {}
  Image log_odds(const View& view, const PixelBox& section, const Prompts& prompts,
                 const std::optional<PixelBox>&) override {
    asked.push_back(prompts);
    Image out(section.width, section.height, 1, 5);
    const bool is_wrong = wrong && int(asked.size()) % wrong == 0 && asked.size() <= table_.views.size();
    for (int y = 0; y < section.height; ++y)
      for (int x = 0; x < section.width; ++x)
        if (!sees_ball(table_, view.camera, {section.x0 + x + 0.5, section.y0 + y + 0.5}) != is_wrong)
          *out.at(x, y) = -5;
    return out;
  }
  std::vector<Prompts> asked;
  int wrong = 0;  // every n-th mask of the first round shows the background instead; 0: none

 private:
  const TestTable& table_;
};

}  // namespace cei3d
