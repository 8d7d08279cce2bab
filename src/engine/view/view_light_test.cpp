// SPDX-License-Identifier: Apache-2.0
// The maps and tables, read as a page reads them, against the closed forms that they stand for.
#include "engine/view/view_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/compute/kernels/shade.h"
#include "core/math/horizon.h"
#include "core/math/lobe_row.h"
#include "core/math/reflection_axis.h"
#include "core/math/rng.h"
#include "core/math/sg.h"
#include "engine/render/lobe_frames.h"
#include "engine/render/lobe_planes.h"
#include "engine/render/test_balls.h"
#include "engine/view/quantize.h"
#include "engine/view/test_pack.h"

namespace cei3d {
namespace {

// Bilinear, as hardware does: nodes are texel centers.
template <class V, class At>
V bilinear(float x, float y, int width, int height, const At& at) {
  const int i = std::clamp(int(x), 0, width - 2), j = std::clamp(int(y), 0, height - 2);
  const float u = x - float(i), v = y - float(j);
  return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) +
         (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

class PageLight {
 public:
  PageLight(const ReadPack& light, const ReadPack& tables)
      : side_(light.head.at("reflection_side")),
        levels_(light.head.at("reflection_levels")),
        columns_(tables.head.at("columns")),
        rows_(tables.head.at("rows")),
        middle_(tables.head.at("middle_share")),
        reflection_(light.array<uint32_t>("reflection")),
        surface_(tables.array<float>("surface")),
        base_(tables.array<float>("base")),
        fresnel_(tables.array<float>("fresnel")) {}

  Vec3f reflected(Vec3f n, Vec3f v, const Material& m) const {
    const Vec3f split = look_up(surface_, dot(n, v), m.roughness);
    const float f0 = dielectric_f0(m.specular, m.metalness) + m.metalness * kMetalF0,
                share = f0 * split.x / (f0 * split.x + f90_of(m.specular, m.metalness) * split.y);
    return along(base_, n, v, m.roughness) * share + along(fresnel_, n, v, m.roughness) * (1 - share);
  }

 private:
  // Three numbers of a table's four.
  Vec3f look_up(const std::vector<float>& table, float nv, float roughness, int first = 0) const {
    const float x = std::sqrt(nv) * float(columns_ - 1),
                y = (roughness - kMinRoughness) / (1 - kMinRoughness) * float(rows_ - 1);
    return bilinear<Vec3f>(x, y, columns_, rows_, [&](int i, int j) {
      const float* t = &table[4 * size_t(j * columns_ + i) + size_t(first)];
      return Vec3f{t[0], t[1], t[2]};
    });
  }
  Vec3f along(const std::vector<float>& table, Vec3f n, Vec3f v, float roughness) const {
    const Vec3f lobe = look_up(table, dot(n, v), roughness);
    const Vec3f axis = normalize(mirrored_direction(n, v) * (1 - lobe.x) + n * lobe.x),
                side = normalize(cross(cross(n, v), axis)) * std::sin(lobe.z);
    const Vec3f turned = axis * std::cos(lobe.z);
    const float steepness = look_up(table, dot(n, v), roughness, 1).z;
    Vec3f sum{0, 0, 0};
    float total = 0;
    for (const auto& [d, weight] :
         {std::pair{axis, middle_}, {turned + side, (1 - middle_) / 2}, {turned - side, (1 - middle_) / 2}}) {
      const float above = weight * logistic(steepness * dot(d, n));
      sum += radiance(d, lobe.y) * above;
      total += above;
    }
    return sum / total;
  }
  Vec3f radiance(Vec3f d, float level) const {
    const float z = level * float(levels_ - 1);
    const int below = std::clamp(int(z), 0, levels_ - 2);
    const float above = z - float(below);
    return in_level(d, below) * (1 - above) + in_level(d, below + 1) * above;
  }
  Vec3f in_level(Vec3f d, int level) const {
    const Vec2f p = octahedron_from_direction(d);
    const auto position = [&](float x) { return (x + 1) / 2 * float(side_ - 1); };
    return bilinear<Vec3f>(position(p.x), position(p.y), side_, side_, [&](int i, int j) {
      return from_shared_exponent(reflection_[size_t((level * side_ + j) * side_ + i)]);
    });
  }

  int side_, levels_, columns_, rows_;
  float middle_;
  std::vector<uint32_t> reflection_;
  std::vector<float> surface_, base_, fresnel_;
};

Vec3f exact(const Device& device, const SgMixture& light, Vec3f n, Vec3f v, const Material& m) {
  const std::vector<float> planes = lobe_planes(light);
  const int stride = padded_to_panels(1);
  const SurfaceReflection<float> r =
      surface_reflection(reflection_tables(), n, v, m.roughness, m.specular, m.metalness);
  const auto along = [&](const LobeFrame<float>& lobe) {
    LobeFrames frames(stride);
    frames.put(0, lobe);
    std::vector<float> out(3 * size_t(stride));
    device.launch<SgReflection>(
        {{planes.data(), int(light.lobes.size()), stride}, stride, frames.planes(), out.data()}, stride);
    return load_planes<float>(out.data(), stride, 0);
  };
  return mean_of_lobes(r.share, along(r.base), along(r.fresnel));
}

TEST(ViewLight, ReflectionsAreThoseOfTheClosedForm) {
  const Device device = make_device();
  const SgMixture sky = some_sky();
  const PageLight page(ReadPack(view_light(device, sky)), ReadPack(view_tables()));
  std::vector<float> errors;
  double mean = 0;
  for (uint64_t i = 0; i < 3000; ++i) {
    Rng rng(11, 0, i);
    const auto direction = [&] { return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}); };
    const Vec3f n = direction();
    Vec3f v = direction();
    if (dot(n, v) < 0) v = -v;
    const Material m{0.05f + 0.75f * rng.uniform(), 0.5f, i % 2 ? 1.0f : 0.0f};
    const Vec3f want = exact(device, sky, n, v, m), got = page.reflected(n, v, m);
    errors.push_back(length(got - want));
    mean += length(want) / 3000;
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[1500], 0.023 * mean);
  EXPECT_LT(errors[2850], 0.095 * mean);
  EXPECT_LT(errors.back(), 0.3 * mean);
}

// The maps of a sky with a sun in it are those of the sky and what the tables say of the sun.
TEST(ViewLight, ASunIsAddedByItsTables) {
  const Device device = make_device();
  constexpr float kSharpness = 1000, kPeak = 500;
  const Vec3f to = normalize(Vec3f{0.3f, -0.5f, 0.8f});
  SgMixture sky = some_sky();
  const ReadPack without(view_light(device, sky)), sun(view_sun(kSharpness));
  sky.lobes.push_back({to, kSharpness, Vec3f{1, 1, 1} * kPeak});
  const ReadPack with(view_light(device, sky));
  const int count = sun.head.at("nodes");
  const auto looked_up = [&](const std::vector<float>& table, int first, float at) {
    const float x = clamp(at, 0.0f, 1.0f) * float(count - 1);
    const int i = std::min(int(x), count - 2);
    const float* t = &table[size_t(first + i)];
    return kPeak * sg_integral(kSharpness) * (t[0] + (t[1] - t[0]) * (x - float(i)));
  };
  const auto expect_sum = [&](const char* map, int side, int levels, auto more) {
    const std::vector<uint32_t> before = without.array<uint32_t>(map), after = with.array<uint32_t>(map);
    const std::vector<float> table = sun.array<float>(map);
    for (int i = 0; i < levels * side * side; ++i) {
      const float want = from_shared_exponent(after[size_t(i)]).y,
                  got = from_shared_exponent(before[size_t(i)]).y +
                        more(table, octahedral_node(i % (side * side), side), i / (side * side));
      ASSERT_NEAR(got, want, 0.01f * want + 0.01f) << map << " " << i;
    }
  };
  expect_sum("irradiance", with.head.at("irradiance_side"), 1,
             [&](const auto& table, Vec3f n, int) { return looked_up(table, 0, 0.5f + 0.5f * dot(n, to)); });
  expect_sum("reflection", with.head.at("reflection_side"), kReflectionLevels,
             [&](const auto& table, Vec3f axis, int level) {
               return looked_up(table, level * count, std::sqrt(length(axis - to) / 2));
             });
}

TEST(ViewLight, LevelsAreTheInverseOfTheirRoughness) {
  for (int level = 0; level < kReflectionLevels; ++level)
    EXPECT_NEAR(reflection_level(reflection_level_roughness(level)), float(level) / (kReflectionLevels - 1),
                1e-5);
}

TEST(ViewLight, IrradianceOfAUniformSkyIsPi) {
  const ReadPack pack(view_light(make_device(), uniform_sky()));
  // Two broad lobes of kBroadestLobe: their sum is 1 + exp(-0.2) at the poles, about 2 exp(-0.1) at the
  // sides.
  for (const uint32_t e : pack.array<uint32_t>("irradiance"))
    EXPECT_NEAR(from_shared_exponent(e).x, kPi * 1.81f, 0.04f * kPi);
}

}  // namespace
}  // namespace cei3d
