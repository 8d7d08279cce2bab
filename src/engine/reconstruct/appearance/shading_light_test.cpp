// SPDX-License-Identifier: Apache-2.0
// A matte painted body under a known light, drawn by the shading model: its shading alone tells the light.
#include "engine/reconstruct/appearance/shading_light.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/reconstruct/appearance/split_rows.h"
#include "engine/reconstruct/appearance/test_drawn.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

const Drawn& matte() {
  static const Drawn drawn = [] {
    Drawn d = draw({0.8f, 0.5f, 0});
    d.colors = d.diffuse;
    return d;
  }();
  return drawn;
}

std::vector<Vec3f> diffuse_radiance(float brightness) {
  std::vector<Vec3f> out = mean_colors(matte().surface->mesh(), matte().samples(), small());
  for (Vec3f& d : out) d = d * brightness;
  return out;
}

std::vector<Vec3f> albedo_under(const ShadingLight& light, const std::vector<Vec3f>& diffuse) {
  std::vector<Vec3f> out;
  for (const uint32_t v : seen(matte())) out.push_back(diffuse[v] * kPi / light.irradiance[v]);
  return out;
}

TEST(ShadingLight, MakesTheAlbedoOfAMatteBodyTheTrueOne) {
  const std::vector<Vec3f> diffuse = diffuse_radiance(1), truth = pick(matte().base, seen(matte()));
  const ShadingLight light = light_of_shading(*matte().transport, diffuse, 1);
  const double even_light = match(pick(diffuse, seen(matte())), truth).error;
  EXPECT_GT(even_light, 0.3);
  EXPECT_LT(match(albedo_under(light, diffuse), truth).error, 0.12);
  for (const Vec3f& l : light.sky) EXPECT_GT(min(l.x, min(l.y, l.z)), 0);
}

// The strength is that under which the brightest places have a known albedo, however bright the photographs.
TEST(ShadingLight, IsAsStrongAsThePhotographsAreBright) {
  const std::vector<Vec3f> diffuse = diffuse_radiance(1), brighter = diffuse_radiance(4);
  const ShadingLight light = light_of_shading(*matte().transport, diffuse, 1),
                     strong = light_of_shading(*matte().transport, brighter, 1);
  for (size_t i = 0; i < light.sky.size(); ++i)
    EXPECT_NEAR(strong.sky[i].y, 4 * light.sky[i].y, 1e-3f * light.sky[i].y + 1e-4f);
  int above = 0, all = 0;
  for (const Vec3f& a : albedo_under(light, diffuse)) above += max(a.x, max(a.y, a.z)) > kBrightAlbedo, ++all;
  EXPECT_NEAR(double(above) / all, 0.02, 0.02);
}

// A ball above a white plate under a small lamp and an even sky.
Mesh ball_over_plate() {
  constexpr int kCells = 48;
  Mesh m = plane_mesh(kCells, kCells, 2.0f / kCells);
  for (Vec3f& p : m.positions) p = p - Vec3f{1, 1, 0.4f};
  const Mesh ball = sphere_mesh(0.3f, 4);
  const auto first = uint32_t(m.positions.size());
  m.positions.insert(m.positions.end(), ball.positions.begin(), ball.positions.end());
  m.normals.insert(m.normals.end(), ball.normals.begin(), ball.normals.end());
  for (const auto& t : ball.triangles) m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return m;
}

TEST(ShadingLight, FindsALampByTheShadowThatItCasts) {
  const auto surface = std::make_shared<const Surface>(ball_over_plate());
  const Transport transport(surface);
  const size_t lamp = [] {
    const Vec3f d = normalize(Vec3f{0.5f, 0.3f, 0.8f});
    return size_t(sky_around(d)[0]);
  }();
  SkyRadiance sky(kSkyDirections, Vec3f{1, 1, 1});
  sky[lamp] = {120, 120, 120};
  std::vector<Vec3f> diffuse = transport.sky(sky);
  for (Vec3f& d : diffuse) d = d * (0.5f / kPi);
  const SkyRadiance found = light_of_shading(transport, diffuse, 1).sky;
  const auto brightest =
      std::max_element(found.begin(), found.end(), [](Vec3f a, Vec3f b) { return a.y < b.y; });
  EXPECT_GT(dot(sky_directions()[size_t(brightest - found.begin())], sky_directions()[lamp]), 0.98f);
  float sum = 0;
  for (const Vec3f& l : found) sum += l.y / kSkyDirections;
  EXPECT_GT(brightest->y, 20 * sum);  // the true one is 97 times as bright as the mean
}

}  // namespace
}  // namespace cei3d
