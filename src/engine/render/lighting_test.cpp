// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lighting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/rotation.h"
#include "engine/render/test_balls.h"

namespace cei3d {
namespace {

TEST(Lighting, AConvexBodyUnderAUniformSkyReflectsItsAlbedoAndItsReflectance) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, 0}, 0.8f);
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  const SgMixture sky = uniform_sky();
  const float level = radiance(sky, {1, 0, 0}).x;
  const std::vector<Vec3f> base(surface->mesh().positions.size(), Vec3f{0.5f, 0.5f, 0.5f});
  const auto hits = some_hits(surface->mesh(), 500);
  const std::vector<Vec3f> albedo(hits.size(), Vec3f{0.5f, 0.2f, 0.9f});
  for (const float metalness : {0.0f, 1.0f}) {
    const Material material{0.3f, 0.5f, metalness};
    const Shading s =
        Lighting(device, surface, sky, base, material).shade(UniformBatch(hits, material), albedo);
    for (size_t i = 0; i < hits.size(); ++i) {
      const float nv = dot(hits[i].normal, hits[i].to_camera);
      const SplitSum<double> e = split_sum_integral(std::max(nv, 0.01f), 0.3);
      EXPECT_NEAR(s.diffuse[i].y / level, (1 - metalness) * 0.2f, 0.01f);
      const float f0 = metalness * 0.9f + (1 - metalness) * 0.04f;
      if (nv > 0.35f) {
        EXPECT_NEAR(s.specular[i].z / level, f0 * e.scale + e.bias, 0.02f) << nv;
      }
      EXPECT_LE(s.specular[i].z, 1.01f * level);  // no energy out of nothing
    }
  }
}

TEST(Lighting, AHitDoesNotCareAboutItsNeighborsInTheBatch) {
  const Mesh mesh = two_spheres(-0.3f);
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  const std::vector<Vec3f> base(surface->mesh().positions.size(), Vec3f{0.5f, 0.4f, 0.3f});
  const Material material{0.25f, 0.5f, 0.2f};
  const Lighting lighting(device, surface, some_sky(), base, material);
  const auto hits = some_hits(surface->mesh(), 5000);
  std::vector<Vec3f> albedo;
  for (size_t i = 0; i < hits.size(); ++i) albedo.push_back({Rng(1, 1, i).uniform(), 0.3f, 0.8f});
  const Shading all = lighting.shade(UniformBatch(hits, material), albedo);
  for (const auto& [begin, end] : {std::pair{0, 1}, {7, 40}, {2040, 2060}, {33, 4999}}) {
    const auto part = lighting.shade(UniformBatch(std::span(hits).subspan(begin, end - begin), material),
                                     std::span(albedo).subspan(begin, end - begin));
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(part.diffuse[i - begin][c], all.diffuse[i][c]);
        ASSERT_EQ(part.specular[i - begin][c], all.specular[i][c]);
      }
  }
}

TEST(Lighting, EveryHitIsShadedWithItsOwnMaterialWhateverElseIsInTheBatch) {
  const Mesh mesh = two_spheres(-0.3f, 24);
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  const std::vector<Vec3f> base(surface->mesh().positions.size(), Vec3f{0.5f, 0.4f, 0.3f});
  const auto hits = some_hits(surface->mesh(), 3000);
  const Material materials[] = {{0.25f, 0.5f, 0.2f}, {0.6f, 0.5f, 0}, {0.25f, 0.9f, 1}};
  std::vector<Material> mixed;
  std::vector<Vec3f> albedo;
  for (size_t i = 0; i < hits.size(); ++i) {
    albedo.push_back({Rng(1, 1, i).uniform(), 0.3f, 0.8f});
    mixed.push_back(materials[Rng(1, 2, i).below(3)]);
  }
  const Lighting lighting(device, surface, some_sky(), base, materials[0]);
  const Shading got = lighting.shade({hits, mixed}, albedo);
  for (const Material& m : materials) {
    const Shading expected = lighting.shade(UniformBatch(hits, m), albedo);
    for (size_t i = 0; i < hits.size(); ++i) {
      if (!(mixed[i] == m)) continue;
      for (int c = 0; c < 3; ++c) {  // bit for bit: an edit of one part leaves the rest alone
        ASSERT_EQ(got.diffuse[i][c], expected.diffuse[i][c]);
        ASSERT_EQ(got.specular[i][c], expected.specular[i][c]);
      }
    }
  }
}

TEST(Lighting, ALampBehindTheSurfaceIsNotReflected) {
  Mesh mesh;
  add_sphere(mesh, {0, 0, 0}, 0.8f);
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  const Vec3f lamp = normalize(Vec3f{1, 0.5f, 0.2f});
  const SgMixture light{{{lamp, 60, {1, 1, 1}}}};
  const std::vector<Vec3f> base(surface->mesh().positions.size(), Vec3f{0.5f, 0.5f, 0.5f});
  const Material metal{0.5f, 0.5f, 1};
  const std::vector<Hit> hits = some_hits(surface->mesh(), 2000);
  const std::vector<IncidentLight<float>> got =
      Lighting(device, surface, light, base, metal).incident_light(UniformBatch(hits, metal));
  double behind = 0, all = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    all += got[i].reflected().y;
    if (dot(hits[i].normal, lamp) < -0.2f) behind += got[i].reflected().y;
  }
  EXPECT_GT(all, 1);
  EXPECT_LT(behind, 3e-3 * all);
}

TEST(Lighting, IrradianceIsTheIntegralOverTheSkyThatIsSeen) {
  // Two spheres: brute-force integration with shadow rays, one bounce left out by a black surface.
  const Mesh mesh = two_spheres(-0.35f);
  const auto surface = std::make_shared<const Surface>(mesh);
  const Device device = make_device();
  const SgMixture sky = some_sky();
  const std::vector<Vec3f> black(surface->mesh().positions.size(), Vec3f{0, 0, 0});
  const Material material{0.3f, 0.5f, 0};
  const Lighting lighting(device, surface, sky, black, material);
  const auto hits = some_hits(surface->mesh(), 60);
  const std::vector<IncidentLight<float>> got = lighting.incident_light(UniformBatch(hits, material));
  double error = 0, total = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    std::vector<Vec3f> o, d;
    for (int k = 0; k < 6000; ++k) {
      const float z = 1 - (2 * float(k) + 1) / 6000, r = std::sqrt(1 - z * z), a = 2.39996323f * float(k);
      const Vec3f w{r * std::cos(a), r * std::sin(a), z};
      if (dot(w, hits[i].normal) <= 0) continue;
      o.push_back(hits[i].position + hits[i].normal * 2e-3f);
      d.push_back(w);
    }
    std::vector<Surface::RayHit> far(o.size());
    surface->intersect(o, d, 0, far);
    double truth = 0;
    for (size_t k = 0; k < d.size(); ++k)
      if (far[k].t < 0) truth += double(radiance(sky, d[k]).y) * dot(d[k], hits[i].normal) * 4 * M_PI / 6000;
    error += std::abs(truth - got[i].irradiance().y);
    total += truth;
  }
  EXPECT_LT(error / total, 0.04);
}

TEST(Transport, AWhiteCavityGlows) {
  // Inside the gap between two spheres, the bounce of a white surface replaces most of what it blocks.
  const Mesh mesh = two_spheres(-0.4f);
  const Transport transport(std::make_shared<const Surface>(mesh));
  const SkyRadiance sky(kSkyDirections, Vec3f{1, 1, 1});
  const auto seen = transport.sky(sky), unoccluded = transport.unoccluded_sky(sky, seen);
  const std::vector<Vec3f> one(seen.size(), Vec3f{1, 1, 1});
  const auto bounce = transport.bounce(one);
  for (size_t v = 0; v < seen.size(); ++v) {
    EXPECT_NEAR(unoccluded[v].x, kPi, 0.02f);
    // What is not sky is surface, and a surface as bright as the sky closes the sum (up to the lift of the
    // rays).
    EXPECT_NEAR(seen[v].x + bounce[v].x, unoccluded[v].x, 0.12f);
  }
}

TEST(Transport, ComputesTheVerticesThatAreAskedForAsItDoesAll) {
  const Transport transport(std::make_shared<const Surface>(two_spheres(-0.4f)));
  SkyRadiance sky;
  for (size_t k = 0; k < kSkyDirections; ++k) sky.push_back(Vec3f{1, 2, 3} * Rng(1, 0, k).uniform());
  const std::vector<Vec3f> seen = transport.sky(sky), bounce = transport.bounce(seen);
  std::vector<uint8_t> which;
  for (size_t v = 0; v < seen.size(); ++v) which.push_back(Rng(2, 0, v).below(3) == 0);
  const std::vector<Vec3f> few_seen = transport.sky(sky, which), few_bounce = transport.bounce(seen, which);
  const auto skies = transport.skies(std::vector{sky, sky}),
             few_skies = transport.skies(std::vector{sky, sky}, which);
  for (size_t v = 0; v < seen.size(); ++v) {
    const float share = float(which[v]);
    EXPECT_EQ(length(few_seen[v] - seen[v] * share), 0);
    EXPECT_EQ(length(few_bounce[v] - bounce[v] * share), 0);
    EXPECT_EQ(length(few_skies[1][v] - skies[1][v] * share), 0);
  }
}

// Two balls in three views, between which the light turns: each view has to look as under a light that stands
// still and is turned accordingly.
class TurningLight : public testing::Test {
 protected:
  static constexpr size_t kViews = 3, kHits = 60;  // hits of each view
  void SetUp() override {
    Mesh mesh;
    add_sphere(mesh, {-0.35f, 0, 0}, 0.3f, 24);
    add_sphere(mesh, {0.35f, 0, 0}, 0.3f, 24);
    for (const Vec3f& p : mesh.positions) {
      made_of_.albedo.push_back({0.8f, 0.5f, 0.3f});
      made_of_.material.push_back(p.x > 0 ? kCopper.material : kClay.material);
    }
    surface_ = std::make_shared<const Surface>(std::move(mesh));
    turns_ = light_turns({Mat3f::identity(), about_axis({0, 0, 1}, 1), about_axis({0.6f, 0.8f, 0}, 2)});
    for (size_t i = 0; i < kViews * kHits; ++i) {
      hits_.push_back(some_hits(surface_->mesh(), i + 1).back());
      views_.push_back(uint16_t(i / kHits));
      materials_.push_back(hits_.back().position.x > 0 ? kCopper.material : kClay.material);
    }
    const Transport transport(surface_);
    together_ = std::make_unique<Lighting>(device_, surface_, some_sky(),
                                           turned_vertex_lights(transport, some_sky(), made_of_, &turns_));
    for (const Mat3f& room_from_object : turns_.room_from_object) {
      const SgMixture light = rotated(some_sky(), transpose(room_from_object));
      apart_.emplace_back(device_, surface_, light, vertex_light(transport, light, made_of_));
    }
  }
  HitBatch all() const { return {hits_, materials_, {&turns_, views_}}; }
  HitBatch of_view(size_t view) const {
    HitBatch batch = all().part(int(view * kHits), int((view + 1) * kHits));
    batch.turned = {};
    return batch;
  }

  Device device_ = make_device();
  VertexMaterials made_of_;
  std::shared_ptr<const Surface> surface_;
  LightTurns turns_;
  std::vector<Hit> hits_;
  std::vector<uint16_t> views_;
  std::vector<Material> materials_;
  std::unique_ptr<Lighting> together_;
  std::vector<Lighting> apart_;
};

void expect_close(Vec3f got, Vec3f want) { EXPECT_LT(length(got - want), 2e-3f * (1 + length(want))); }

TEST_F(TurningLight, ShadesEveryViewAsItsTurnedLightDoes) {
  const std::vector<Vec3f> albedo(hits_.size(), Vec3f{0.7f, 0.4f, 0.2f});
  const Shading got = together_->shade(all(), albedo);
  for (size_t view = 0; view < kViews; ++view) {
    const Shading want = apart_[view].shade(of_view(view), std::span(albedo).first(kHits));
    for (size_t i = 0; i < kHits; ++i) {
      expect_close(got.diffuse[view * kHits + i], want.diffuse[i]);
      expect_close(got.specular[view * kHits + i], want.specular[i]);
    }
  }
}

TEST_F(TurningLight, HasTheSlopesOfItsTurnedLight) {
  const std::vector<Vec3f> albedo(hits_.size(), Vec3f{0.7f, 0.4f, 0.2f}),
      weight(hits_.size(), Vec3f{0.5f, -1, 0.8f});
  const ShadingGrads got = together_->grad(all(), together_->incident_light(all()), albedo, weight);
  for (size_t view = 0; view < kViews; ++view) {
    const HitBatch batch = of_view(view);
    const ShadingGrads want =
        apart_[view].grad(batch, apart_[view].incident_light(batch), std::span(albedo).first(kHits),
                          std::span(weight).first(kHits));
    for (size_t i = 0; i < kHits; ++i) {
      expect_close(got.d_normal[view * kHits + i], want.d_normal[i]);
      expect_close(got.d_view[view * kHits + i], want.d_view[i]);
    }
  }
}

// A convex body, so that nothing occludes a reflection, and the loss a random weight of every hit's radiance.
class LightingGrad : public testing::Test {
 protected:
  static constexpr size_t kHits = 40;
  void SetUp() override {
    Mesh mesh;
    add_sphere(mesh, {0, 0, 0}, 0.7f);
    const std::vector<Vec3f> gray(mesh.positions.size(), Vec3f{0.5f, 0.5f, 0.5f});
    surface_ = std::make_shared<const Surface>(std::move(mesh));
    lighting_ = std::make_unique<Lighting>(device_, surface_, some_sky(), gray, Material{});
    hits_ = some_hits(surface_->mesh(), kHits);
    for (size_t i = 0; i < kHits; ++i) {
      const auto random = [&](uint64_t k) { return Rng(1, i, k).uniform(); };
      materials_.push_back({0.2f + 0.6f * random(6), random(7), random(8)});
      albedo_.push_back({random(0), random(1), random(2)});
      weight_.push_back({2 * random(3) - 1, 2 * random(4) - 1, 2 * random(5) - 1});
    }
    grads_ = std::make_unique<ShadingGrads>(lighting_->grad(
        {hits_, materials_}, lighting_->incident_light({hits_, materials_}), albedo_, weight_));
  }
  double loss(size_t i, const Hit& hit, const Material& material, Vec3f albedo) const {
    const Shading s = lighting_->shade({std::span(&hit, 1), std::span(&material, 1)}, std::span(&albedo, 1));
    return double(dot(weight_[i], s.diffuse[0] + s.specular[0]));
  }
  // Central difference of f(step), against which the derivative is checked.
  template <class F>
  static void expect_slope(double slope, const F& f, double h, const std::string& what) {
    const double want = (f(float(h)) - f(float(-h))) / (2 * h);
    EXPECT_NEAR(slope, want, 0.03 * std::abs(want) + 0.003) << what;
  }

  Device device_ = make_device();
  std::shared_ptr<const Surface> surface_;
  std::unique_ptr<Lighting> lighting_;
  std::vector<Hit> hits_;
  std::vector<Material> materials_;
  std::vector<Vec3f> albedo_, weight_;
  std::unique_ptr<ShadingGrads> grads_;
};

TEST_F(LightingGrad, OfMaterialAndAlbedoEqualsDifferences) {
  for (size_t i = 0; i < kHits; ++i) {
    const auto at = [&](float Material::*x) {
      return [&, x](float h) {
        Material m = materials_[i];
        m.*x += h;
        return loss(i, hits_[i], m, albedo_[i]);
      };
    };
    expect_slope(grads_->d_material[i].roughness, at(&Material::roughness), 0.004, "roughness");
    expect_slope(grads_->d_material[i].specular, at(&Material::specular), 0.02, "specular");
    expect_slope(grads_->d_material[i].metalness, at(&Material::metalness), 0.02, "metalness");
    for (int c = 0; c < 3; ++c)
      expect_slope(
          grads_->d_albedo[i][c],
          [&](float h) {
            Vec3f a = albedo_[i];
            a[c] += h;
            return loss(i, hits_[i], materials_[i], a);
          },
          0.02, "albedo");
  }
}

TEST_F(LightingGrad, OfNormalAndViewEqualsDifferencesAlongTheSphere) {
  for (size_t i = 0; i < kHits; ++i) {
    const auto turned = [&](Vec3f Hit::*x, Vec3f t) {
      return [&, x, t](float h) {
        Hit hit = hits_[i];
        hit.*x = normalize(hit.*x + t * h);
        return loss(i, hit, materials_[i], albedo_[i]);
      };
    };
    const Vec3f axis{0.3f, 0.5f, 0.8f};
    const Vec3f by_n = normalize(cross(hits_[i].normal, axis)),
                by_v = normalize(cross(hits_[i].to_camera, axis));
    expect_slope(dot(grads_->d_normal[i], by_n), turned(&Hit::normal, by_n), 0.004, "normal");
    expect_slope(dot(grads_->d_view[i], by_v), turned(&Hit::to_camera, by_v), 0.004, "view");
  }
}

TEST_F(LightingGrad, OfNormalsIncludesIrradianceWhereItIsTakenAtHits) {
  lighting_->use_hit_normals();
  const HitBatch batch{hits_, materials_};
  const ShadingGrads grads = lighting_->grad(batch, lighting_->incident_light(batch), albedo_, weight_);
  double changed = 0;
  for (size_t i = 0; i < kHits; ++i) {
    const Vec3f t = normalize(cross(hits_[i].normal, Vec3f{0.3f, 0.5f, 0.8f}));
    const auto turned = [&](float h) {
      Hit hit = hits_[i];
      hit.normal = normalize(hit.normal + t * h);
      return loss(i, hit, materials_[i], albedo_[i]);
    };
    expect_slope(dot(grads.d_normal[i], t), turned, 0.012, "normal");  // over kinks of the table
    changed += length(grads.d_normal[i] - grads_->d_normal[i]);
  }
  EXPECT_GT(changed, 0.1);
}

TEST_F(LightingGrad, OfTheEnvironmentsLightEqualsDifferences) {
  // The light's color scales both kinds of light at once: dL/d(scale) is the sum of slope times light.
  const std::vector<IncidentLight<float>> light = lighting_->incident_light({hits_, materials_});
  double slope = 0;
  for (size_t i = 0; i < kHits; ++i)
    slope += double(dot(grads_->d_sky_irradiance[i], light[i].sky_irradiance) +
                    dot(grads_->d_sky_reflection[i], light[i].sky_reflection));
  const auto scaled_loss = [&](float h) {
    lighting_->set_lobes(scaled(some_sky(), {1 + h, 1 + h, 1 + h}));
    double sum = 0;
    for (size_t i = 0; i < kHits; ++i) sum += loss(i, hits_[i], materials_[i], albedo_[i]);
    return sum;
  };
  expect_slope(slope, scaled_loss, 0.05, "scale of the light");
}

}  // namespace
}  // namespace cei3d
