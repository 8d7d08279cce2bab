// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/edge_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/reconstruct/pixels.h"
#include "engine/synthetic/views.h"
#include "model/geometry/mesh/test_meshes.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {
namespace {

constexpr float kHalf = 0.31f;  // of the upper plate's side
constexpr int kSize = 40;

void add_plate(float half, float height, Mesh& m) {
  const auto first = uint32_t(m.positions.size());
  for (const Vec2f c : {Vec2f{-1, -1}, Vec2f{1, -1}, Vec2f{1, 1}, Vec2f{-1, 1}}) {
    m.positions.push_back({c.x * half, c.y * half, height});
    m.normals.push_back({0, 0, 1});
  }
  m.triangles.push_back({first, first + 1, first + 2});
  m.triangles.push_back({first, first + 2, first + 3});
}

// A plate that fills the picture from above, and a smaller one at a height over it.
struct Plates {
  Surface surface;
  PixelStore pixels;
  std::vector<Hit> hits;
  std::vector<SeenAt> seen;

  explicit Plates(float height) : surface(mesh(height)) {
    const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, {kSize, kSize, 60}, {0, 1, 0});
    pixels.add_view(camera, Image(kSize, kSize, 4, 1), 0);
    for (size_t p = 0; p < pixels.pixels().size(); ++p) {
      const Ray ray = pixels.ray(pixels.pixels()[p]);
      const Vec3f above = at_height(ray, height);
      hits.push_back({in_plate(above) ? above : at_height(ray, 0), {0, 0, 1}, -ray.direction, 0, 0, 0});
      const Pixel& at = pixels.pixels()[p];
      seen.push_back({at.view, at.x, at.y});
    }
  }
  static Mesh mesh(float height) {
    Mesh m;
    add_plate(3, 0, m);
    add_plate(kHalf, height, m);
    return m;
  }
  static Vec3f at_height(const Ray& r, float z) {
    return r.origin + r.direction * ((z - r.origin.z) / r.direction.z);
  }
  static bool in_plate(Vec3f p) { return std::abs(p.x) < kHalf && std::abs(p.y) < kHalf; }
};

TEST(EdgePixels, AreThoseWithinAPixelOfAnEdge) {
  constexpr float kHeight = 0.3f;
  const Plates plates(kHeight);
  const std::vector<uint8_t> edge =
      on_edges(plates.surface, plates.pixels.cameras(), plates.hits, plates.seen);
  int edges = 0;
  for (size_t i = 0; i < edge.size(); ++i) {
    const auto above = [&](Vec2f away) {
      return Plates::in_plate(Plates::at_height(plates.pixels.ray(plates.pixels.pixels()[i], away), kHeight));
    };
    const bool want = above({1, 0}) != above({0, 0}) || above({-1, 0}) != above({0, 0}) ||
                      above({0, 1}) != above({0, 0}) || above({0, -1}) != above({0, 0});
    EXPECT_EQ(edge[i], want) << i;
    edges += want;
  }
  EXPECT_GT(edges, 40);  // about eight sides of fourteen pixels
}

TEST(EdgePixels, AreNotThoseAtALowStep) {
  const Plates plates(0.04f);  // a pixel is .05 wide
  for (const uint8_t edge : on_edges(plates.surface, plates.pixels.cameras(), plates.hits, plates.seen))
    EXPECT_EQ(edge, 0);
}

TEST(EdgePixels, AreThoseAtTheBackground) {
  Plates plates(0.3f);
  Mesh alone;
  add_plate(kHalf, 0, alone);
  const Surface surface(std::move(alone));
  const Ray border = plates.pixels.ray(plates.pixels.pixels()[0]);
  // The hit of a pixel whose neighbors all miss.
  const std::vector<Hit> hit{{Plates::at_height(border, 0), {0, 0, 1}, -border.direction, 0, 0, 0}};
  EXPECT_EQ(on_edges(surface, plates.pixels.cameras(), hit, std::span(plates.seen).first(1))[0], 1);
}

}  // namespace
}  // namespace cei3d
