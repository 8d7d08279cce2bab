// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/propagate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "engine/segment/seen_points.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.7f;
constexpr int kSize = 96;
using Truth = std::function<bool(Vec3f)>;  // whether a point of the surface is on the part

Camera camera_at(Vec3d center) {
  Camera c;
  c.width = c.height = kSize;
  c.fx = c.fy = 1.5 * kSize;
  c.cx = c.cy = kSize / 2.0;
  c.center = center;
  c.world_from_cam = upright_rotation(-center, {0.1, 0.2, 1});
  return c;
}

// Around the equator, and from above and below.
std::vector<Camera> ring() {
  std::vector<Camera> cameras;
  for (int k = 0; k < 12; ++k) {
    const double a = 2 * M_PI * k / 12;
    cameras.push_back(camera_at({2.5 * std::cos(a), 2.5 * std::sin(a), k % 2 ? 0.8 : -0.8}));
  }
  return cameras;
}

// Near-uniform points of a sphere (Fibonacci).
HandlerPoints sphere_points(int n) {
  HandlerPoints h;
  for (int i = 0; i < n; ++i) {
    const float z = 1 - (2 * float(i) + 1) / float(n), r = std::sqrt(1 - z * z), a = 2.399963f * float(i);
    h.normals.push_back({r * std::cos(a), r * std::sin(a), z});
    h.positions.push_back(h.normals.back() * kRadius);
    h.footprints.push_back(0.01f);
  }
  h.spacing = kRadius * std::sqrt(4 * kPi / float(n)) * 0.9f;
  return h;
}

// Knows the truth, on a sphere; lies in some views by telling its opposite.
class Oracle : public ViewSegmenter {
 public:
  Oracle(std::vector<Camera> cameras, Truth truth) : cameras_(std::move(cameras)), truth_(std::move(truth)) {}
  Image mask(int view, std::span<const Vec2f> positive, std::span<const Vec2f> negative) override {
    asked.insert(view);
    for (Vec2f p : positive) wrong_prompts += at(view, p) <= 0;
    for (Vec2f p : negative) wrong_prompts += at(view, p) > 0;
    Image m(kSize, kSize, 1);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        *m.at(x, y) = at(view, {float(x) + 0.5f, float(y) + 0.5f}) * (liars.count(view) ? -1.0f : 1.0f);
    return m;
  }
  std::set<int> liars, asked;
  int wrong_prompts = 0;

 private:
  float at(int view, Vec2f pixel) const {
    const Ray ray = cameras_[view].ray(pixel.x, pixel.y);
    const float b = dot(ray.origin, ray.direction);
    const float d = b * b - dot(ray.origin, ray.origin) + kRadius * kRadius;
    if (d < 0) return -6;
    return truth_(ray.origin - ray.direction * (b + std::sqrt(d))) ? 6.0f : -6.0f;
  }
  std::vector<Camera> cameras_;
  Truth truth_;
};

Surface sphere() { return Surface(sphere_mesh(kRadius, 5)); }

bool band(Vec3f p) { return std::abs(p.z) < 0.25f; }

// Clicked where the band is nearest to the first camera.
PropagateRequest band_request() {
  PropagateRequest r;
  r.cameras = ring();
  const Vec3d p = r.cameras[0].project({kRadius, 0, 0});
  r.clicks.positive = {{float(p.x), float(p.y)}};
  return r;
}

// Share of the points whose score is on the right side.
double right(const HandlerPoints& h, const std::vector<float>& scores, const Truth& truth) {
  int n = 0;
  for (size_t i = 0; i < scores.size(); ++i)
    n += (scores[i] > 0.5f) == truth(h.positions[i]) && scores[i] != 0.5f;
  return double(n) / double(scores.size());
}

TEST(Propagate, GoesAroundTheObject) {
  const HandlerPoints h = sphere_points(6000);
  PropagateRequest request = band_request();
  // truth.
  Oracle oracle(request.cameras, band);
  Progress silent;
  const PropagateResult r = propagate(h, sphere(), request, oracle, silent);
  EXPECT_LE(oracle.asked.size(), 10u);
  EXPECT_TRUE(r.report.refused.empty());
  EXPECT_EQ(oracle.wrong_prompts, 0);
  // All but what lies within half a pixel or so of the border.
  EXPECT_GT(right(h, r.scores, band), 0.97);
}

TEST(Propagate, RefusesAMaskThatContradictsWhatIsKnown) {
  const HandlerPoints h = sphere_points(6000);
  PropagateRequest request = band_request();
  Progress silent;
  Oracle honest(request.cameras, band);
  const std::vector<int> views = propagate(h, sphere(), request, honest, silent).report.views;
  Oracle liar(request.cameras, band);
  liar.liars = {views[1]};
  const PropagateResult r = propagate(h, sphere(), request, liar, silent);
  EXPECT_EQ(r.report.refused, std::vector<int>{views[1]});
  EXPECT_GT(right(h, r.scores, band), 0.95);
}

TEST(Propagate, GoesWhereMuchIsKnownBeforeItGoesFar) {
  // The farther of two views shows more that is new, but little that is known.
  const HandlerPoints h = sphere_points(4000);
  PropagateRequest request = band_request();
  request.cameras = {camera_at({2.5, 0, 0}), camera_at({2.5 * std::cos(1.4), 2.5 * std::sin(1.4), 0}),
                     camera_at({2.5 * std::cos(0.7), 2.5 * std::sin(0.7), 0})};
  request.clicks.positive = {{kSize / 2.0f, kSize / 2.0f}};
  Oracle oracle(request.cameras, band);
  Progress silent;
  EXPECT_EQ(propagate(h, sphere(), request, oracle, silent).report.views, (std::vector<int>{0, 2, 1}));
}

TEST(Propagate, AsksForMoreViewsWhereMasksDisagree) {
  const HandlerPoints h = sphere_points(6000);
  PropagateRequest request = band_request();
  request.cameras.clear();
  for (int k = 0; k < 12; ++k)
    request.cameras.push_back(camera_at({2.5, 1.2 * std::cos(k * M_PI / 6), 1.2 * std::sin(k * M_PI / 6)}));
  request.clicks.positive = {{kSize / 2.0f, kSize / 2.0f}};
  const auto disc = [](float radius) {
    return [radius](Vec3f p) { return length(p - Vec3f{kRadius, 0, 0}) < radius; };
  };
  Progress silent;
  const auto views = [&](const Truth& first, const Truth& others) {
    struct Mixed : ViewSegmenter {
      Oracle first, others;
      Mixed(Oracle a, Oracle b) : first(std::move(a)), others(std::move(b)) {}
      Image mask(int view, std::span<const Vec2f> in, std::span<const Vec2f> out) override {
        return (view == 0 ? first : others).mask(view, in, out);
      }
    } mixed({request.cameras, first}, {request.cameras, others});
    return propagate(h, sphere(), request, mixed, silent).report.views.size();
  };
  const size_t agreed = views(disc(0.3f), disc(0.3f)), disagreed = views(disc(0.3f), disc(0.36f));
  EXPECT_LE(agreed, 4u);
  EXPECT_GT(disagreed, agreed);
}

TEST(Propagate, HiddenPointsHaveNoVote) {
  // One view: what lies behind the sphere projects into the mask, too.
  const HandlerPoints h = sphere_points(4000);
  PropagateRequest request = band_request();
  request.plan.max_views = 1;
  const Camera& c = request.cameras[0];
  Oracle oracle(request.cameras, [](Vec3f) { return true; });
  Progress silent;
  const std::vector<float> scores = propagate(h, sphere(), request, oracle, silent).scores;
  for (size_t i = 0; i < scores.size(); ++i) {
    const float facing = dot(h.normals[i], normalize(to_float(c.center) - h.positions[i]));
    if (facing < 0.19f) {
      EXPECT_EQ(scores[i], 0.5f);
    }
    if (facing > 0.21f) {
      EXPECT_GT(scores[i], 0.6f);
    }
  }
}

TEST(Propagate, AMaskOfTheUserStandsForTheFirstView) {
  const HandlerPoints h = sphere_points(6000);
  PropagateRequest request = band_request();
  Oracle truth(request.cameras, band);
  request.mask = truth.mask(0, {}, {});
  for (float& m : request.mask.data) m = m > 0;
  request.clicks = {};
  Oracle oracle(request.cameras, band);
  Progress silent;
  const PropagateResult r = propagate(h, sphere(), request, oracle, silent);
  EXPECT_EQ(oracle.asked.count(0), 0u);
  EXPECT_GT(r.report.views.size(), 4u);
  EXPECT_GT(right(h, r.scores, band), 0.95);
}

TEST(Propagate, InAdjacentOrderEachViewIsTheNearestOneLeft) {
  const HandlerPoints h = sphere_points(3000);
  PropagateRequest request = band_request();
  request.plan = {ViewPlan::kAll, ViewOrder::adjacent, MaskCombination::any};
  Oracle oracle(request.cameras, band);
  Progress silent;
  const std::vector<int> views = propagate(h, sphere(), request, oracle, silent).report.views;
  ASSERT_EQ(views.size(), request.cameras.size());
  for (size_t k = 0; k + 1 < views.size(); ++k) {
    const auto cosine = [&](int v) {
      return dot(normalize(request.cameras[size_t(v)].center),
                 normalize(request.cameras[size_t(views[k])].center));
    };
    for (size_t later = k + 2; later < views.size(); ++later)
      EXPECT_GE(cosine(views[k + 1]), cosine(views[later]) - 1e-9);
  }
}

TEST(Propagate, AnyMaskCountsInTheUnion) {
  // One view shows a second place as part: the union has more of it than the votes.
  const HandlerPoints h = sphere_points(6000);
  PropagateRequest request = band_request();
  request.plan.max_views = ViewPlan::kAll;
  const auto spot = [](Vec3f p) { return length(p - Vec3f{0.45f, 0.26f, 0.46f}) < 0.12f; };  // in view 1
  Progress silent;
  const auto share_of_spot = [&](MaskCombination combination) {
    request.plan.combination = combination;
    Oracle honest(request.cameras, band);
    Oracle wrong(request.cameras, [&](Vec3f p) { return band(p) || spot(p); });
    struct Mixed : ViewSegmenter {
      Oracle &honest, &wrong;
      Mixed(Oracle& a, Oracle& b) : honest(a), wrong(b) {}
      Image mask(int view, std::span<const Vec2f> in, std::span<const Vec2f> out) override {
        return (view == 1 ? wrong : honest).mask(view, in, out);
      }
    } mixed(honest, wrong);
    const std::vector<float> scores = propagate(h, sphere(), request, mixed, silent).scores;
    int in = 0, all = 0;
    for (size_t i = 0; i < scores.size(); ++i)
      if (spot(h.positions[i])) in += scores[i] > 0.5f, ++all;
    return double(in) / all;
  };
  const double any = share_of_spot(MaskCombination::any);
  EXPECT_GT(any, 0.5);
  EXPECT_LT(share_of_spot(MaskCombination::votes), any);
}

TEST(Propagate, SaysSoWhenNothingIsFound) {
  const HandlerPoints h = sphere_points(1000);
  const PropagateRequest request = band_request();
  Oracle oracle(request.cameras, [](Vec3f) { return false; });
  Progress silent;
  EXPECT_THROW(propagate(h, sphere(), request, oracle, silent), Error);
}

TEST(SeenPoints, NotThroughOtherSurfaces) {
  // Two spheres in a row: of the rear one's points that face the camera, those behind the front one are
  // hidden.
  Mesh mesh = sphere_mesh(0.2f, 3);
  const Mesh front = sphere_mesh(0.2f, 3);
  const auto n = uint32_t(mesh.positions.size());
  for (Vec3f& p : mesh.positions) p.x -= 0.5f;
  for (size_t i = 0; i < n; ++i) {
    mesh.positions.push_back(front.positions[i] + Vec3f{0.5f, 0, 0});
    mesh.normals.push_back(front.normals[i]);
  }
  for (auto t : front.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  const Surface surface(std::move(mesh));
  const std::vector<Vec3f> positions{{-0.3f, 0, 0}, {0.7f, 0, 0}}, normals{{1, 0, 0}, {1, 0, 0}};
  const auto seen = seen_points(surface, camera_at({3, 0, 0}), positions, normals, 0.2f, 0.02f);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].point, 1u);
  EXPECT_NEAR(seen[0].pixel.x, kSize / 2.0, 1e-3);
  EXPECT_NEAR(seen[0].facing, 1, 1e-5);
}

TEST(SeenPoints, SampleIsExactOnALinearPicture) {
  Image image(5, 4, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) *image.at(x, y) = 2 * (float(x) + 0.5f) - 3 * (float(y) + 0.5f);
  EXPECT_NEAR(sample(image, {2.2f, 1.9f}), 2 * 2.2f - 3 * 1.9f, 1e-5);
  EXPECT_EQ(sample(image, {-7, -7}), *image.at(0, 0));
  EXPECT_EQ(sample(image, {99, 99}), *image.at(4, 3));
}

TEST(Prompts, SpreadFromTheMiddleOfAStroke) {
  std::vector<Vec2f> line;
  for (int x = 0; x <= 100; ++x) line.push_back({float(x), 7});
  const std::vector<Vec2f> some = spread(line, 3);
  ASSERT_EQ(some.size(), 3u);
  EXPECT_EQ(some[0].x, 50);
  EXPECT_EQ(some[1].x + some[2].x, 100);  // both ends
  EXPECT_EQ(spread(std::span(line).first(2), 5).size(), 2u);
  EXPECT_TRUE(spread({}, 5).empty());
}

TEST(Prompts, KeepAwayFromTheBorderAndFromEachOther) {
  BelievedPixels pixels;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) (x < 20 ? pixels.in : pixels.out).push_back({float(x), float(y)});
  Prompts prompts;
  add_prompts(pixels, 4, prompts);
  ASSERT_EQ(prompts.positive.size(), 4u);
  ASSERT_EQ(prompts.negative.size(), 4u);
  for (const auto* kind : {&prompts.positive, &prompts.negative})
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_GT(std::abs((*kind)[i].x - 19.5f), 4);
      for (size_t j = 0; j < i; ++j)
        EXPECT_GT(std::hypot((*kind)[i].x - (*kind)[j].x, (*kind)[i].y - (*kind)[j].y), 8);
    }
  const std::vector<Vec2f> wrong{{0, 0}, {5, 5}, {9, 9}}, right{{10, 10}, {0, 1}};
  EXPECT_EQ(deepest(wrong, right).x, 5);
}

}  // namespace
}  // namespace cei3d
