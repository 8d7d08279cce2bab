// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/material_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/facets.h"
#include "core/math/fibonacci.h"
#include "core/math/reflection_axis.h"
#include "core/math/shading.h"
#include "model/light/envmap.h"
#include "model/light/sg_mixture.h"

namespace cei3d {
namespace {

constexpr int kHeight = 24, kViews = 300;

SgMixture studio() {
  return {{{normalize(Vec3f{1, 0.4f, 1}), 30, {6, 5.5f, 5}},
           {normalize(Vec3f{-1, 1, 0.3f}), 25, {2, 2.5f, 3}},
           {{0, 0, 1}, 1.5f, {0.4f, 0.45f, 0.5f}}}};
}

std::vector<Vec3f> image_of(const SgMixture& light) {
  std::vector<Vec3f> out;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 2 * kHeight; ++x)
      out.push_back(radiance(light, env_direction(float(x) + 0.5f, float(y) + 0.5f, 2 * kHeight, kHeight)));
  return out;
}

// What the surface reflects of the light, per unit of F0 and without F0, by quadrature over its facets.
ReflectedParts<float> reflected(const SgMixture& light, const SplitRow& row, float roughness) {
  const Vec3f side = cross(row.normal, row.to_camera), y = normalize(side), x = cross(y, row.normal);
  ReflectedParts<float> sum{{0, 0, 0}, {0, 0, 0}};
  for_reflections(row.nv, roughness, [&](double weight, const Vec3d& l, double vh) {
    const auto rise = float(fresnel(0.0, vh)), share = float(weight) / 2;
    for (const double at : {l.y, -l.y}) {
      const Vec3f sky = radiance(light, x * float(l.x) + y * float(at) + row.normal * float(l.z)) * share;
      sum.base += sky * (1 - rise);
      sum.fresnel += sky * rise;
    }
  });
  return sum;
}

// One vertex, seen from all sides of its hemisphere; its normal differs from sample to sample, as at a bump.
std::vector<SplitRow> samples_of(const Material& m, Vec3f diffuse, Vec3f metal) {
  std::vector<SplitRow> rows;
  for (int i = 0; i < kViews; ++i) {
    SplitRow row{};
    row.vertices = {0, 0, 0};
    row.barycentric = {1, 0, 0};
    row.normal = normalize(Vec3f{0.3f, 0.2f, 1} + fibonacci_direction(7 * i % kViews, kViews) * 0.4f);
    row.to_camera = fibonacci_direction(i, kViews);
    row.nv = dot(row.normal, row.to_camera);
    if (row.nv < 0.2f) continue;
    row.color = reflected(studio(), row, m.roughness).sum(f0_of(metal, m.specular, m.metalness));
    if (m.metalness == 0) row.color += diffuse * diffuse_view(row.nv, m.roughness);
    row.weight = {1, 1, 1};
    rows.push_back(row);
  }
  return rows;
}

BestMaterials best_of(BlurLadder& blurs, const std::vector<SplitRow>& rows) {
  std::vector<Vec3f> colors;
  for (const SplitRow& r : rows) colors.push_back(r.color);
  const LitSamples lit(1, rows, colors, blurs, image_of(studio()));
  return best_materials(lit.evidence({Vec3f{1, 1, 1}}).of(0));
}

TEST(MaterialEvidence, FindsTheRoughnessAndTheKindOfAMaterial) {
  BlurLadder blurs(kHeight);
  for (const float roughness : {0.22f, 0.4f, 0.65f}) {
    const Material matte{roughness, 0.5f, 0}, metallic{roughness, 0.5f, 1};
    const BestMaterials dielectric = best_of(blurs, samples_of(matte, {0.15f, 0.1f, 0.05f}, {})),
                        metal = best_of(blurs, samples_of(metallic, {}, {0.9f, 0.6f, 0.3f}));
    EXPECT_NEAR(dielectric.dielectric_roughness / roughness, 1, 0.12);
    EXPECT_NEAR(metal.metal_roughness / roughness, 1, 0.12);
    EXPECT_LT(dielectric.dielectric_error, 0.2f * dielectric.metal_error);
    // A rough metal is the farther from its lobes the rougher it is.
    EXPECT_LT(metal.metal_error, (roughness < 0.5f ? 0.05f : 0.4f) * metal.dielectric_error);
  }
}

// Views that judge a separation have no say in it.
TEST(MaterialEvidence, IsNotOfSamplesThatAreHeldOut) {
  BlurLadder blurs(kHeight);
  const std::vector<SplitRow> matte = samples_of({0.4f, 0.5f, 0}, {0.15f, 0.1f, 0.05f}, {});
  std::vector<SplitRow> rows = matte;
  for (SplitRow row : samples_of({0.22f, 0.5f, 1}, {}, {0.9f, 0.6f, 0.3f})) {
    row.held_out = true;
    rows.push_back(row);
  }
  EXPECT_EQ(best_of(blurs, rows).dielectric_error, best_of(blurs, matte).dielectric_error);
}

// A strip of vertices, two a column, of two colors with the border in the middle.
struct Strip {
  Mesh mesh;
  std::vector<Vec3f> colors;
  MaterialEvidence evidence;

  explicit Strip(uint32_t columns) {
    for (uint32_t i = 0; i < 2 * columns; ++i) {
      mesh.positions.push_back({float(i / 2), float(i % 2), 0});
      colors.push_back(i < columns ? Vec3f{0.8f, 0.2f, 0.1f} : Vec3f{0.1f, 0.3f, 0.9f});
    }
    for (uint32_t i = 0; i + 2 < 2 * columns; i += 2) {
      mesh.triangles.push_back({i, i + 2, i + 1});
      mesh.triangles.push_back({i + 1, i + 2, i + 3});
    }
    evidence.error.assign(size_t(2) * columns * MaterialEvidence::kHypotheses, 0);
    evidence.samples.assign(size_t(2) * columns, 0);
  }
  SimilarNeighbors neighbors() const { return {mesh, colors}; }
  // The errors of all dielectrics and of all metals at a vertex.
  void set(uint32_t vertex, float dielectric, float metal) {
    evidence.samples[vertex] = 1;
    for (int h = 0; h < MaterialEvidence::kHypotheses; ++h)
      evidence.error[size_t(vertex) * MaterialEvidence::kHypotheses + size_t(h)] =
          h < BlurLadder::kLevels ? dielectric : metal;
  }
};

// Evidence spreads within a color and does not cross the border.
TEST(MaterialEvidence, SpreadsWithinAColor) {
  constexpr uint32_t kColumns = 12;
  constexpr int kH = MaterialEvidence::kHypotheses;
  Strip strip(kColumns);
  MaterialEvidence& e = strip.evidence;
  e.samples[2] = 1;
  for (int h = 0; h < kH; ++h) e.error[2 * kH + size_t(h)] = float(h);
  diffuse_evidence(strip.neighbors(), 60, e);
  for (uint32_t i = 0; i < 2 * kColumns; ++i) {
    const bool near = i < kColumns;
    EXPECT_EQ(e.samples[i] > 1e-3f, near) << i;
    for (int h = 0; h < kH; ++h)
      EXPECT_NEAR(e.of(i)[h], e.samples[i] * float(h), 1e-5f);  // one scale for all
  }
}

// A metal with a few vertices that slightly favor a dielectric, which take after what surrounds them. Beside
// it a dielectric of another color that is in doubt everywhere: the metal does not spread over it.
TEST(MaterialEvidence, DoubtfulVerticesAreOfTheKindAroundThem) {
  constexpr uint32_t kColumns = 40;
  Strip strip(kColumns);
  const auto doubtful = [](uint32_t v) { return v / 2 % 20 >= 9 && v / 2 % 20 < 12; };
  for (uint32_t v = 0; v < 2 * kColumns; ++v) {
    const float better = doubtful(v) || v >= kColumns ? 0.8f : 0.05f;
    const bool metal = (v < kColumns) != doubtful(v);
    strip.set(v, metal ? 1 : better, metal ? better : 1);
  }
  const std::vector<float> p = metal_probability(strip.neighbors(), strip.evidence, 1, 150);
  for (uint32_t v = 0; v < 2 * kColumns; ++v) EXPECT_EQ(p[v] > 0.5f, v < kColumns) << v;
}

// What vertices say where no others disagree: even odds at the given ratio of errors.
TEST(MaterialEvidence, OddsAreEvenAtTheGivenRatio) {
  constexpr uint32_t kColumns = 4;
  for (const float ratio : {0.5f, 0.84f, 0.86f, 2.0f}) {
    Strip strip(kColumns);
    for (uint32_t v = 0; v < 2 * kColumns; ++v) strip.set(v, 1, ratio);
    for (const int steps : {0, 150})
      for (const float p : metal_probability(strip.neighbors(), strip.evidence, 0.85f, steps))
        EXPECT_EQ(p > 0.5f, ratio < 0.85f) << ratio;
  }
}

}  // namespace
}  // namespace cei3d
