// SPDX-License-Identifier: Apache-2.0
// A painted body under a known light, drawn by the shading model and taken apart again.
#include "engine/reconstruct/appearance/linear_split.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "core/math/quantile.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/reconstruct/appearance/test_drawn.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

TEST(LinearSplit, FindsLightRoughnessAndAlbedoOfADielectric) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), small(), quiet);
  EXPECT_TRUE(split.materials.empty());  // one
  EXPECT_EQ(split.material.metalness, 0);
  EXPECT_NEAR(split.material.roughness, 0.3f, 0.03f);
  const Match albedo = match(pick(split.albedo, seen(d)), pick(d.base, seen(d)));
  EXPECT_NEAR(albedo.scale, 1, 0.15);
  EXPECT_LT(albedo.error, 0.04);
  std::vector<Vec3f> got, truth;
  for (int y = 0; y < split.light.height; ++y)
    for (int x = 0; x < split.light.width; ++x) {
      got.push_back(split.light.rgb(x, y) * env_solid_angle(y, split.light.width, split.light.height));
      truth.push_back(radiance(studio(), env_direction(float(x) + 0.5f, float(y) + 0.5f, split.light.width,
                                                       split.light.height)) *
                      env_solid_angle(y, split.light.width, split.light.height));
      EXPECT_GE(split.light.rgb(x, y).y, 0);
    }
  EXPECT_LT(match(got, truth).error, 0.45);  // a deconvolution: sharp spots come out spiky
}

// Where a part of the body hides a part of the sky, less is reflected. A light that is taken to be seen whole
// everywhere comes out too weak, here by a quarter, and colors too bright.
TEST(LinearSplit, TheLightIsAsStrongWhereTheBodyHidesAPartOfIt) {
  const auto plastic = [](Vec3f) { return Material{0.3f, 0.5f, 0}; };
  const Drawn d = draw(plastic, paint, LightMotion::world, two_bumpy_balls());
  LinearSplitOptions o = small();
  o.fixed_roughness = 0.3f;
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), o, quiet);
  const Match albedo = match(pick(split.albedo, seen(d)), pick(d.base, seen(d)));
  EXPECT_NEAR(albedo.scale, 1, 0.04);
  EXPECT_LT(albedo.error, 0.05);
}

// Many lights on every point: what no light that stands still explains.
TEST(LinearSplit, FindsAlbedoUnderALightThatTurns) {
  const Drawn d = draw([](Vec3f) { return Material{0.3f, 0.5f, 0}; }, paint, LightMotion::turntable);
  Progress quiet;
  const LightFrame frame =
      find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, {}, quiet);
  ASSERT_EQ(frame.motion, LightMotion::turntable);
  const auto turns = turns_of(frame, d.cameras);
  SurfaceSamples samples = d.samples();
  samples.turned = {turns.get(), d.views};
  const LinearSplit split = linear_split(*d.transport, samples, small(), quiet);
  EXPECT_TRUE(split.materials.empty());
  EXPECT_NEAR(split.material.roughness, 0.3f, 0.05f);
  const Match albedo = match(pick(split.albedo, seen(d)), pick(d.base, seen(d)));
  EXPECT_NEAR(albedo.scale, 1, 0.15);
  EXPECT_LT(albedo.error, 0.05);
}

// One of two balls is sampled, which reflects the other one.
TEST(LinearSplit, SamplesOfAllPatchesAreAllSamples) {
  Drawn d = draw(
      [](Vec3f) {
        return Material{0.3f, 0.5f, 0};
      },
      paint, LightMotion::turntable, two_bumpy_balls());
  size_t n = 0;
  for (size_t i = 0; i < d.hits.size(); ++i) {
    if (d.hits[i].position.x < 0) continue;
    d.hits[n] = d.hits[i], d.colors[n] = d.colors[i], d.views[n] = d.views[i];
    ++n;
  }
  d.hits.resize(n), d.colors.resize(n), d.views.resize(n);
  const auto turns = turns_of(light_frame(LightMotion::turntable, d.cameras, {0, 0, 1}), d.cameras);
  SurfaceSamples samples = d.samples();
  samples.turned = {turns.get(), d.views};
  LinearSplitOptions o = small();
  o.max_hits = int(n);
  o.hold_out = 5;
  Progress quiet;
  const std::vector<double> all = held_out_residuals(*d.transport, samples, o, 0.3f, false, quiet);
  o.in_patches = true;
  EXPECT_GT(all.size(), 2u);
  EXPECT_EQ(held_out_residuals(*d.transport, samples, o, 0.3f, false, quiet), all);
}

// What one photograph has that the others do not, no light explains; it must not decide.
TEST(LinearSplit, ADarkPhotographDoesNotHideThatTheLightTurns) {
  constexpr uint16_t kDark = 10;  // one of every fifth view, which judge
  Drawn d = draw([](Vec3f) { return Material{0.3f, 0.5f, 0}; }, paint, LightMotion::turntable);
  for (size_t i = 0; i < d.colors.size(); ++i)
    if (d.views[i] == kDark) d.colors[i] = d.colors[i] * 0.3f;
  Progress quiet;
  EXPECT_EQ(find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, {}, quiet).motion,
            LightMotion::turntable);
}

// Where no light explains much, here because of noise of a quarter, the residuals of one material are too
// similar to tell.
TEST(LinearSplit, MaterialsOfTheVerticesTellWhereOneMaterialCannot) {
  Drawn d = draw([](Vec3f) { return Material{0.3f, 0.5f, 0}; }, paint, LightMotion::camera);
  Rng rng(3, 0, 0);
  for (Vec3f& c : d.colors) c = c * (1 + 0.25f * rng.normal());
  Progress quiet;
  EXPECT_EQ(find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, {}, quiet).motion,
            LightMotion::camera);
}

TEST(LinearSplit, TakesALightThatStandsStillForWhatItIs) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  Progress quiet;
  EXPECT_EQ(find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, {}, quiet).motion,
            LightMotion::world);
}

// Ratios of channels of a light.
Vec3f hue(const Image& light) {
  Vec3f sum{0, 0, 0};
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x)
      sum += light.rgb(x, y) * env_solid_angle(y, light.width, light.height);
  return sum / sum.y;
}

// Under orange lamps: smooth surfaces show it, and so it stays; where nothing is known but what users say,
// that counts.
TEST(LinearSplit, TheColorOfTheLightIsWhatHighlightsShowOrUsersSay) {
  constexpr Vec3f kOrange{1.4f, 1, 0.65f};
  Drawn d = draw({0.3f, 0.5f, 0});
  for (Vec3f& c : d.colors) c = c * kOrange;
  LinearSplitOptions o = small();
  o.fixed_roughness = 0.3f;
  Progress quiet;
  const LinearSplit believed = linear_split(*d.transport, d.samples(), o, quiet);
  o.light_color.kind = LightColorPrior::Kind::free;
  const Vec3f free = hue(linear_split(*d.transport, d.samples(), o, quiet).light);
  EXPECT_LT(length(hue(believed.light) - free), 0.1f);
  const auto error = relative_error(believed.light_error);
  ASSERT_TRUE(error);
  EXPECT_LT(max(error->x, max(error->y, error->z)), 0.2f);
  o.light_color = {LightColorPrior::Kind::known, {1, 1, 1}};
  EXPECT_LT(length(hue(linear_split(*d.transport, d.samples(), o, quiet).light) - Vec3f{1, 1, 1}), 0.02f);
}

// A body drawn 1.5 times whiter than white is one under a brighter light that reflects less than is taken for
// granted.
TEST(LinearSplit, MakesNoSurfaceSendOutMoreThanArrives) {
  const Drawn d = draw({0.3f, 0.5f, 0}, 1.5f / 0.6f);
  LinearSplitOptions o = small();
  o.fixed_roughness = 0.3f;
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), o, quiet);
  EXPECT_LT(split.material.specular, 0.45f);
  for (int c = 0; c < 3; ++c) {
    size_t white = 0, above = 0;
    for (const uint32_t v : seen(d)) white += split.albedo[v][c] >= 1, above += d.base[v][c] > 1;
    EXPECT_LT(double(white), 0.1 * double(above) + 0.05 * double(d.base.size()));
  }
}

// A gray body on which a spot, a hundredth of its surface, is drawn 2.5 times whiter than white.
TEST(LinearSplit, ASmallWhiteSpotIsNotCutOff) {
  const Vec3f middle = normalize(Vec3f{1, 0.2f, 0.3f}) * 0.75f;
  const auto away = [&](Vec3f p) { return length(p - middle); };
  const Drawn d = draw(
      [](Vec3f) {
        return Material{0.3f, 0.5f, 0};
      },
      [&](Vec3f p) {
        const float a = away(p) < 0.17f ? 2.5f : 0.5f;
        return Vec3f{a, a, a};
      });
  LinearSplitOptions o = small();
  o.fixed_roughness = 0.3f;
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), o, quiet);
  double spot = 0, spots = 0, rest = 0, rests = 0;
  for (const uint32_t v : seen(d)) {
    const float at = away(d.surface->mesh().positions[v]);
    if (at < 0.12f) spot += luminance(split.albedo[v]), ++spots;
    if (at > 0.25f) rest += luminance(split.albedo[v]), ++rests;
  }
  ASSERT_GT(spots, 5);
  EXPECT_LT(split.material.specular, 0.25f);
  EXPECT_NEAR((spot / spots) / (rest / rests), 5, 0.5);
}

Drawn matte_body() {
  Drawn d = draw({0.8f, 0.5f, 0});
  d.colors = d.diffuse;
  return d;
}

// Where nothing is reflected, least squares make the light vanish. Its shading still tells it.
TEST(LinearSplit, AMatteBodyHasTheLightOfItsShading) {
  const Drawn d = matte_body();
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), small(), quiet);
  EXPECT_FALSE(relative_error(split.light_error));  // the strength is assumed
  EXPECT_LT(split.material.specular, 0.3f);
  EXPECT_LT(match(pick(split.albedo, seen(d)), pick(d.base, seen(d))).error, 0.15);
}

TEST(LinearSplit, TheLightOfAMatteBodyHasTheColorThatTheUserKnows) {
  const Drawn d = matte_body();
  LinearSplitOptions options = small();
  options.light_color = {LightColorPrior::Kind::known, {1.2f, 1, 0.7f}};
  Progress quiet;
  const Image light = linear_split(*d.transport, d.samples(), options, quiet).light;
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      EXPECT_NEAR(light.rgb(x, y).x, 1.2f * light.rgb(x, y).y, 1e-4f * light.rgb(x, y).y);
      EXPECT_NEAR(light.rgb(x, y).z, 0.7f * light.rgb(x, y).y, 1e-4f * light.rgb(x, y).y);
    }
}

TEST(LinearSplit, TellsAMetalFromADielectric) {
  const Drawn d = draw({0.25f, 0.5f, 1});
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), small(), quiet);
  EXPECT_TRUE(split.materials.empty());
  EXPECT_EQ(split.material.metalness, 1);
  EXPECT_LT(split.material.roughness, 0.3f);  // a metal's residual is flat below the truth
  // Up to one factor, which reflections leave open.
  EXPECT_LT(match(pick(split.albedo, seen(d)), pick(d.base, seen(d))).error, 0.15);
}

Vec3f gold_and_copper(Vec3f p) {
  const bool stripe = std::sin(9 * p.x + 4 * p.z) > 0;
  return stripe ? Vec3f{0.95f, 0.64f, 0.54f} : Vec3f{1.0f, 0.77f, 0.34f};
}

// The search begins at one roughness and must get far away from it in both directions.
TEST(LinearSplit, FindsPorcelainBesideDullCopper) {
  const Material above{0.5f, 0.5f, 1}, below{0.2f, 0.5f, 0};
  const Drawn d = draw([&](Vec3f p) { return p.z > 0 ? above : below; },
                       [](Vec3f p) { return p.z > 0 ? gold_and_copper(p) : paint(p); });
  LinearSplitOptions o = small();
  o.search_height = o.light_height;
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), o, quiet);
  ASSERT_EQ(split.materials.size(), d.base.size());
  std::vector<float> copper, porcelain;
  for (const uint32_t v : seen(d))
    (d.surface->mesh().positions[v].z > 0 ? copper : porcelain).push_back(split.materials[v].roughness);
  EXPECT_NEAR(value_of_rank(copper, copper.size() / 2), above.roughness, 0.1);
  EXPECT_NEAR(value_of_rank(porcelain, porcelain.size() / 2), below.roughness, 0.1);
}

// A body whose upper half is of metals and whose lower half is a rougher dielectric.
TEST(LinearSplit, FindsSeveralMaterialsAndTheirBorder) {
  const Material above{0.25f, 0.5f, 1}, below{0.4f, 0.5f, 0};
  const Drawn d = draw([&](Vec3f p) { return p.z > 0 ? above : below; },
                       [](Vec3f p) { return p.z > 0 ? gold_and_copper(p) : paint(p); });
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), small(), quiet);
  ASSERT_EQ(split.materials.size(), d.base.size());
  size_t wrong = 0;
  double above_roughness = 0, below_roughness = 0, metals = 0;
  for (const uint32_t v : seen(d)) {
    const bool metal = d.surface->mesh().positions[v].z > 0;
    wrong += (split.materials[v].metalness > 0.5f) != metal;
    metals += metal;
    (metal ? above_roughness : below_roughness) += split.materials[v].roughness;
  }
  EXPECT_LT(double(wrong), 0.04 * double(seen(d).size()));
  EXPECT_NEAR(above_roughness / metals, above.roughness, 0.08);
  EXPECT_NEAR(below_roughness / (double(seen(d).size()) - metals), below.roughness, 0.1);
  const Match albedo = match(pick(split.albedo, seen(d)), pick(d.base, seen(d)));
  EXPECT_NEAR(albedo.scale, 1, 0.25);
  EXPECT_LT(albedo.error, 0.2);
}

// A cap of rough metal: one dielectric explains the pictures to 36 dB, under a light that is wrong.
TEST(LinearSplit, FindsRoughMetalBesideRoughPaint) {
  const Material above{0.7f, 0.5f, 1}, below{0.7f, 0.5f, 0};
  const Drawn d = draw([&](Vec3f p) { return p.z > 0.35 ? above : below; },
                       [](Vec3f p) { return p.z > 0.35 ? gold_and_copper(p) : paint(p); });
  Progress quiet;
  const LinearSplit split = linear_split(*d.transport, d.samples(), small(), quiet);
  ASSERT_EQ(split.materials.size(), d.base.size());
  size_t wrong = 0;
  for (const uint32_t v : seen(d))
    wrong += (split.materials[v].metalness > 0.5f) != (d.surface->mesh().positions[v].z > 0.35);
  EXPECT_LT(double(wrong), 0.1 * double(seen(d).size()));
}

TEST(LinearSplit, IsTheSameEveryTimeAndSaysWhenThereIsTooLittle) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  LinearSplitOptions o = small();
  o.fixed_roughness = 0.3f;
  o.max_hits = 8000;
  Progress quiet;
  const LinearSplit a = linear_split(*d.transport, d.samples(), o, quiet),
                    b = linear_split(*d.transport, d.samples(), o, quiet);
  EXPECT_EQ(a.light.data, b.light.data);
  EXPECT_THROW(
      linear_split(*d.transport, {std::span(d.hits).first(10), std::span(d.colors).first(10), {}}, o, quiet),
      Error);
}

TEST(LinearSplit, SeveralMaterialsThatAreExpectedNeedLessEvidence) {
  EXPECT_TRUE(several_explain_more(2e-3, 1.4e-3, false));
  EXPECT_FALSE(several_explain_more(2e-3, 1.6e-3, false));
  EXPECT_TRUE(several_explain_more(2e-3, 1.6e-3, true));
  EXPECT_FALSE(several_explain_more(2e-3, 1.8e-3, true));
  EXPECT_FALSE(several_explain_more(1.5e-4, 0.6e-4, true));  // less than the noise of photographs
}

// Counts the rounds of the search for materials.
struct Rounds : Progress {
  int count = 0;
  void on_log(const std::string& line) override {
    const Json j = Json::parse(line);
    count += j["stage"] == "materials" && j.contains("round");
  }
};

// On one material with noise the search ends early; but not after polishing with several.
TEST(LinearSplit, SeveralMaterialsThatAreExpectedAreSearchedToTheEnd) {
  Drawn d = draw({0.3f, 0.5f, 0});
  Rng rng(7, 0, 0);
  for (Vec3f& c : d.colors) c = c * (0.8f + 0.4f * rng.uniform());
  LinearSplitOptions o = small();
  for (const bool expected : {false, true}) {
    o.several_expected = expected;
    Rounds rounds;
    EXPECT_TRUE(linear_split(*d.transport, d.samples(), o, rounds).materials.empty()) << expected;
    EXPECT_EQ(rounds.count > 2, expected) << rounds.count;
  }
}

}  // namespace
}  // namespace cei3d
