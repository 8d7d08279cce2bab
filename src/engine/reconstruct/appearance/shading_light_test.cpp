// SPDX-License-Identifier: Apache-2.0
// A matte painted body under a known light, drawn by the shading model: its shading alone tells the light.
#include "engine/reconstruct/appearance/shading_light.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/appearance/split_rows.h"
#include "engine/reconstruct/appearance/test_drawn.h"

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
  std::vector<Vec3f> out =
      mean_colors(matte().base.size(), make_split_rows(*matte().surface, matte().samples(), small()));
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
  const ShadingLight light = light_of_shading(*matte().transport, diffuse, 32, 1);
  const double even_light = match(pick(diffuse, seen(matte())), truth).error;
  EXPECT_GT(even_light, 0.3);
  EXPECT_LT(match(albedo_under(light, diffuse), truth).error, 0.12);
  for (const Vec3f& l : light.radiance) EXPECT_GT(min(l.x, min(l.y, l.z)), 0);
}

// The strength is that under which the brightest places have a known albedo, however bright the photographs.
TEST(ShadingLight, IsAsStrongAsThePhotographsAreBright) {
  const std::vector<Vec3f> diffuse = diffuse_radiance(1), brighter = diffuse_radiance(3);
  const ShadingLight light = light_of_shading(*matte().transport, diffuse, 16, 1),
                     strong = light_of_shading(*matte().transport, brighter, 16, 1);
  for (size_t i = 0; i < light.radiance.size(); ++i)
    EXPECT_NEAR(strong.radiance[i].y, 3 * light.radiance[i].y, 1e-3f * light.radiance[i].y + 1e-4f);
  int above = 0, all = 0;
  for (const Vec3f& a : albedo_under(light, diffuse)) above += max(a.x, max(a.y, a.z)) > kBrightAlbedo, ++all;
  EXPECT_NEAR(double(above) / all, 0.02, 0.02);
}

}  // namespace
}  // namespace cei3d
