// SPDX-License-Identifier: Apache-2.0
// Fits of what a surface hides and shows in reflections, against the renderer's own values elsewhere.
#include "engine/view/reflection_fit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/math/mirror.h"
#include "core/math/rng.h"
#include "engine/render/test_balls.h"
#include "engine/view/test_pack.h"

namespace cei3d {
namespace {

// Two copper balls.
struct Balls {
  Device device = make_device();
  std::shared_ptr<const Surface> surface = std::make_shared<const Surface>(two_spheres(-0.32f, 24));
  size_t n = surface->mesh().positions.size();
  Appearance look{std::vector<Vec3f>(n, kCopper.albedo), std::vector<Material>(n, kCopper.material),
                  std::vector<int>(n, -1)};
  Lighting lighting{device, surface, some_sky(), look.albedo, kCopper.material};
  ViewMesh view{std::vector<uint32_t>(n), surface->mesh().triangles};
  std::vector<ReflectionFit> fits;

  Balls() {
    std::iota(view.vertices.begin(), view.vertices.end(), 0u);
    fits = reflection_fits(lighting, *surface, view, look);
  }
};

float at(const VisibilityTerms& terms, const VisibilityTerms& basis) {
  return std::inner_product(terms.begin(), terms.end(), basis.begin(), 0.0f);
}

// Mean errors of what is reflected, by the fits and if nothing were hidden.
TEST(ReflectionFit, SaysWhatTheRendererSays) {
  const Balls b;
  std::vector<Hit> hits = vertex_hits(b.surface->mesh());
  for (size_t v = 0; v < hits.size(); ++v) {
    Rng rng(8, 0, v);
    hits[v].to_camera = normalize(hits[v].normal + Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.5f);
    if (dot(hits[v].to_camera, hits[v].normal) < 0.1f) hits[v].to_camera = hits[v].normal;
  }
  const std::vector<IncidentLight<float>> light =
      b.lighting.incident_light(UniformBatch(hits, kCopper.material));
  double by_fit = 0, open = 0;
  int hidden = 0;
  for (size_t v = 0; v < hits.size(); ++v) {
    const VisibilityTerms basis = visibility_basis(mirrored_direction(hits[v].normal, hits[v].to_camera));
    Vec3f object{0, 0, 0};
    for (size_t k = 0; k < kVisibilityTerms; ++k) object += b.fits[v].object[k] * basis[k];
    const Vec3f truth = light[v].reflected(), sky = light[v].sky_reflection,
                got = sky * clamp(at(b.fits[v].visibility, basis), 0.0f, 1.0f) + object;
    if (length(truth - sky) == 0) continue;
    ++hidden;
    by_fit += length(got - truth);
    open += length(sky - truth);
  }
  ASSERT_GT(hidden, 300);
  EXPECT_LT(by_fit, 0.4 * open);
}

TEST(ReflectionFit, ThePackHoldsTheTerms) {
  const Balls b;
  const ReadPack pack(view_reflections(b.fits));
  const auto object = pack.array<int8_t>("object");
  const auto visibility = pack.array<int8_t>("visibility");
  for (size_t v = 0; v < b.n; v += 7) {
    const float root = float(object[28 * v + 27]) / 127,
                scale = root * root * pack.head.at("object_scale").get<float>();
    for (size_t k = 0; k < kVisibilityTerms; ++k) {
      const auto at = [&](size_t c) { return float(object[28 * v + 3 * k + c]) / 127 * scale; };
      EXPECT_LT(length(Vec3f{at(0), at(1), at(2)} - b.fits[v].object[k]), 0.01f * scale + 1e-6f);
      EXPECT_NEAR(float(visibility[12 * v + k]) / 127 * pack.head.at("visibility_scale").get<float>(),
                  b.fits[v].visibility[k], 0.02f);
    }
  }
}

}  // namespace
}  // namespace cei3d
