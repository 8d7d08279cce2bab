// SPDX-License-Identifier: Apache-2.0
// A painted body under a known light, drawn by the shading model and taken apart again.
#include "engine/reconstruct/appearance/linear_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/render/lighting.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

// A bumpy ball, so that directions and places don't coincide.
Mesh bumpy_ball(int n = 40) {
  Mesh m;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float t = kPi * float(i) / float(n), p = kPi * float(j) / float(n);
      const Vec3f d{std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
      m.positions.push_back(
          d * (0.75f + 0.06f * std::sin(5 * d.x) * std::sin(4 * d.y + 1) + 0.05f * std::sin(6 * d.z)));
    }
  const auto at = [&](int i, int j) { return uint32_t(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i < n - 1) m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  // One vertex a pole.
  for (auto& t : m.triangles)
    for (uint32_t& v : t) {
      if (v < uint32_t(2 * n)) v = 0;
      if (v >= uint32_t(2 * n * n)) v = uint32_t(2 * n * n);
    }
  return m;
}

Vec3f paint(Vec3f p) {
  const bool stripe = std::sin(9 * p.x + 4 * p.z) > 0;
  return stripe ? Vec3f{0.6f, 0.3f, 0.15f} : Vec3f{0.2f, 0.35f, 0.5f};
}

SgMixture studio() {
  return {{{normalize(Vec3f{1, 0.4f, 1}), 40, {6, 5.5f, 5}},
           {normalize(Vec3f{-1, 1, 0.3f}), 25, {2, 2.5f, 3}},
           {normalize(Vec3f{0.2f, -1, 0.5f}), 60, {4, 4, 4}},
           {{0, 0, 1}, 1.5f, {0.4f, 0.45f, 0.5f}},
           {{0, 0, -1}, 2, {0.2f, 0.18f, 0.15f}}}};
}

struct Drawn {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Transport> transport;
  std::vector<Vec3f> base;
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;
  std::vector<Camera> cameras;
  std::vector<uint16_t> views;  // of the hits
  std::vector<uint8_t> clipped = {};
  SurfaceSamples samples() const { return {hits, colors, clipped}; }
};

using Materials = std::function<Material(Vec3f position)>;
using Colors = std::function<Vec3f(Vec3f position)>;

Camera looking_at_the_origin(Vec3f eye) {
  Camera camera;
  camera.center = to_double(eye);
  camera.world_from_cam = upright_rotation(to_double(-eye), {0, 0, 1});
  return camera;
}

// motion: how the light turns from view to view, about +Z.
Drawn draw(const Materials& material_at, const Colors& color_at, LightMotion motion = LightMotion::world) {
  Drawn d;
  d.surface = std::make_shared<const Surface>(bumpy_ball());
  d.transport = std::make_shared<Transport>(d.surface);
  const Mesh& m = d.surface->mesh();
  for (const Vec3f& p : m.positions) d.base.push_back(color_at(p));
  std::vector<Vec3f> origins, directions;
  for (int view = 0; view < 40; ++view) {
    const float z = 1 - (2 * float(view) + 1) / 40, r = std::sqrt(1 - z * z), a = 2.39996323f * float(view);
    const Vec3f eye = Vec3f{r * std::cos(a), r * std::sin(a), z} * 3.0f;
    d.cameras.push_back(looking_at_the_origin(eye));
    for (int k = 0; k < 800; ++k) {
      Rng rng(1, uint64_t(view), uint64_t(k));
      const Vec3f q = Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.4f;
      origins.push_back(eye);
      directions.push_back(normalize(q - eye));
    }
  }
  std::vector<Surface::RayHit> far(origins.size());
  d.surface->intersect(origins, directions, 0, far);
  std::vector<Vec3f> albedo;
  for (size_t i = 0; i < far.size(); ++i) {
    if (far[i].t < 0) continue;
    const auto& t = m.triangles[far[i].triangle];
    const float b1 = far[i].b1, b2 = far[i].b2;
    const Vec3f n = normalize(m.normals[t[0]] * (1 - b1 - b2) + m.normals[t[1]] * b1 + m.normals[t[2]] * b2);
    d.views.push_back(uint16_t(i / 800));
    d.hits.push_back({origins[i] + directions[i] * far[i].t, n, -directions[i], far[i].triangle, b1, b2});
    albedo.push_back(d.base[t[0]] * (1 - b1 - b2) + d.base[t[1]] * b1 + d.base[t[2]] * b2);
  }
  const Device device = make_device();
  std::vector<Material> of_vertices, of_hits;
  for (const Vec3f& p : m.positions) of_vertices.push_back(material_at(p));
  for (const Hit& h : d.hits) of_hits.push_back(material_at(h.position));
  const LightFrame frame = light_frame(motion, d.cameras, {0, 0, 1});
  for (size_t begin = 0, end; begin < d.hits.size(); begin = end) {
    for (end = begin; end < d.hits.size() && d.views[end] == d.views[begin];) ++end;
    const Mat3f room_from_object = frame.room_from_object(d.cameras[d.views[begin]].world_from_cam);
    const SgMixture light = rotated(studio(), transpose(room_from_object));
    const Lighting lighting(device, d.surface, light,
                            vertex_light(*d.transport, light, {d.base, of_vertices}));
    const Shading s = lighting.shade(HitBatch{d.hits, of_hits}.part(int(begin), int(end)),
                                     std::span(albedo).subspan(begin, end - begin));
    for (size_t i = 0; i < end - begin; ++i) d.colors.push_back(s.diffuse[i] + s.specular[i]);
  }
  return d;
}

Drawn draw(const Material& everywhere, float brightness = 1) {
  return draw([=](Vec3f) { return everywhere; }, [=](Vec3f p) { return paint(p) * brightness; });
}

LinearSplitOptions small() {
  LinearSplitOptions o;
  o.light_height = 32;
  o.search_height = 24;
  o.search_hits = 30000;
  return o;
}

// Vertices that enough samples saw.
std::vector<uint32_t> seen(const Drawn& d) {
  std::vector<int> count(d.base.size(), 0);
  for (const Hit& h : d.hits)
    for (const uint32_t v : d.surface->mesh().triangles[h.triangle]) ++count[v];
  std::vector<uint32_t> out;
  for (uint32_t v = 0; v < count.size(); ++v)
    if (count[v] >= 5) out.push_back(v);
  return out;
}
std::vector<Vec3f> pick(const std::vector<Vec3f>& values, const std::vector<uint32_t>& at) {
  std::vector<Vec3f> out;
  for (const uint32_t i : at) out.push_back(values[i]);
  return out;
}

// Least-squares factor from got to truth, and the relative error that remains.
struct Match {
  double scale, error;
};
Match match(const std::vector<Vec3f>& got, const std::vector<Vec3f>& truth) {
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    ab += dot(got[i], truth[i]);
    aa += dot(got[i], got[i]);
    bb += dot(truth[i], truth[i]);
  }
  return {ab / aa, std::sqrt(std::max(0.0, 1 - ab * ab / (aa * bb)))};
}

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

// Many lights on every point: what no light that stands still explains.
TEST(LinearSplit, FindsAlbedoUnderALightThatTurns) {
  const Drawn d = draw([](Vec3f) { return Material{0.3f, 0.5f, 0}; }, paint, LightMotion::turntable);
  Progress quiet;
  const LightFrame frame =
      find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, 1, quiet);
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

TEST(LinearSplit, TakesALightThatStandsStillForWhatItIs) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  Progress quiet;
  EXPECT_EQ(find_light_frame({d.surface, d.samples()}, d.views, d.cameras, {0, 0, 1}, 1, quiet).motion,
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

AppearanceOptions brief(float roughness) {
  AppearanceOptions o;
  o.albedo.encoding = {0, 8, 8, 64, 12};
  o.albedo.width = 16;
  o.albedo.output_activation = Activation::sigmoid;
  o.effort = Effort::brief;
  o.roughness = roughness;
  o.albedo_steps = 150;
  o.refine_steps = 12;
  return o;
}

// What the object of the result looks like where the drawn one was seen.
std::vector<Vec3f> redrawn(const Device& device, const Drawn& d, const AppearanceResult& a) {
  std::vector<Vec3f> x;
  for (const Hit& h : d.hits) x.push_back(h.position);
  const Lighting lighting(device, d.surface, a.light, a.split.albedo, a.material.mean(), d.transport);
  const Shading s = lighting.shade(UniformBatch(d.hits, a.material.mean()), a.albedo->eval3(device, x));
  std::vector<Vec3f> out(x.size());
  for (size_t i = 0; i < x.size(); ++i) out[i] = s.diffuse[i] + s.specular[i];
  return out;
}

TEST(AppearanceStage, ExplainsThePicturesAndGivesTheSameBitsTwice) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  const AppearanceOptions o = brief(0.3f);
  Progress quiet;
  const Device device = make_device();
  const AppearanceResult a = fit_appearance(device, {d.surface, d.samples()}, o, quiet);
  const std::vector<Vec3f> got = redrawn(device, d, a);
  double error = 0, total = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const Vec3f e = got[i] - d.colors[i];
    error += dot(e, e);
    total += dot(d.colors[i], d.colors[i]);
  }
  EXPECT_LT(std::sqrt(error / total), 0.08);
  const AppearanceResult b = fit_appearance(device, {d.surface, d.samples()}, o, quiet);
  EXPECT_EQ(to_array(a.light), to_array(b.light));
  for (size_t i = 0; i < a.albedo->params().all().size(); ++i)
    EXPECT_EQ(a.albedo->params().all()[i].value, b.albedo->params().all()[i].value);
}

// Where a picture clips red, green and blue still tell the light's color, and the darker stripes, which
// mirror the same light unclipped, its strength.
TEST(AppearanceStage, TakesClippedChannelsForLowerBounds) {
  constexpr float kWhite = 0.7f;
  Drawn d = draw({0.3f, 0.5f, 1});
  const std::vector<Vec3f> truth = d.colors;
  std::vector<size_t> red;  // samples of which nothing but red is clipped
  for (size_t i = 0; i < truth.size(); ++i) {
    uint8_t bits = 0;
    for (int c = 0; c < 3; ++c) {
      if (truth[i][c] < kWhite) continue;
      bits |= uint8_t(1 << c);
      d.colors[i][c] = kWhite;
    }
    d.clipped.push_back(bits);
    if (bits == 1) red.push_back(i);
  }
  ASSERT_GT(red.size(), 200u);
  Progress quiet;
  const Device device = make_device();
  AppearanceOptions options = brief(0.3f);
  options.refine_steps = 50;  // after fewer, colors still move
  const auto means = [&] {
    const std::vector<Vec3f> got =
        redrawn(device, d, fit_appearance(device, {d.surface, d.samples()}, options, quiet));
    Vec3f mean{0, 0, 0};
    for (const size_t i : red) mean += got[i] / truth[i] / float(red.size());
    return mean;
  };
  const Vec3f bounded = means();
  d.clipped.clear();  // as if the pictures were right
  const Vec3f believed = means();
  EXPECT_LT(std::abs(bounded.x - 1), 0.5f * std::abs(believed.x - 1));
  EXPECT_GT(bounded.x, 0.88f);
  EXPECT_NEAR(bounded.y, 1, 0.07);
  EXPECT_NEAR(bounded.z, 1, 0.07);
}

}  // namespace
}  // namespace cei3d
