// SPDX-License-Identifier: Apache-2.0
// The derivative of the samples' diffuse radiance by a turning light against differences.
#include "engine/reconstruct/appearance/split_irradiance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/rotation.h"
#include "engine/render/sphere_scene.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kHeight = 24, kViews = 5;
constexpr size_t kRows = 300;

// A gray lat-long light: uniform, and `size` times random harmonics.
std::vector<Vec3f> harmonic_light(uint64_t seed, float uniform, float size) {
  Harmonics weight{};
  for (size_t j = 1; j < kHarmonics; ++j) weight[j] = size * Rng(seed, 0, j).normal();
  std::vector<Vec3f> light;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 2 * kHeight; ++x) {
      const Harmonics h = harmonics(env_direction(float(x) + 0.5f, float(y) + 0.5f, 2 * kHeight, kHeight));
      float sum = uniform;
      for (size_t j = 0; j < kHarmonics; ++j) sum += weight[j] * h[j];
      light.push_back({sum, sum, sum});
    }
  return light;
}

struct Turning {
  std::shared_ptr<const Surface> surface = std::make_shared<const Surface>(sphere_mesh(16, 32));
  Transport transport{surface};
  LightTurns turns;
  SplitUnknowns x;
  SplitMaterials materials;
  std::vector<SplitRow> rows = std::vector<SplitRow>(kRows);

  Turning() {
    std::vector<Mat3f> rotations;
    for (int view = 0; view < kViews; ++view)
      rotations.push_back(about_axis({0.6f, 0, 0.8f}, 1.2f * float(view)));
    turns = light_turns(rotations);
    const Mesh& mesh = surface->mesh();
    materials = one_material(mesh.positions.size(), {0.4f, 0.5f, 0});
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      const float d = 0.2f + 0.5f * Rng(1, 0, v).uniform();
      x.diffuse.push_back({d, d, d});
    }
    x.light = harmonic_light(2, 2, 0.2f);
    for (size_t i = 0; i < kRows; ++i) {
      Rng rng(3, 0, i);
      rows[i] = {};
      rows[i].vertices = mesh.triangles[rng.below(uint32_t(mesh.triangles.size()))];
      rows[i].barycentric = barycentrics(0.5f * rng.uniform(), 0.5f * rng.uniform());
      rows[i].view = uint16_t(rng.below(kViews));
    }
  }
  // The light of the rows that `step` times `change` is added to.
  std::vector<SplitRow> turned(const std::vector<Vec3f>& change, float step) const {
    SplitUnknowns moved = x;
    for (size_t i = 0; i < moved.light.size(); ++i) moved.light[i] += change[i] * step;
    std::vector<SplitRow> out = rows;
    TurningIrradiance(transport, turns, kHeight).turn(moved, materials, out);
    return out;
  }
};

TEST(TurningIrradiance, DerivativeByTheLightEqualsDifferences) {
  constexpr float kStep = 0.05f;
  Turning t;
  std::vector<SplitRow> rows = t.rows;
  const DiffuseLightGrad grad =
      TurningIrradiance(t.transport, t.turns, kHeight).turn(t.x, t.materials, rows).grad;
  const std::vector<Vec3f> change = harmonic_light(4, 0.3f, 0.5f);
  const HarmonicLight harmonics_of_change = LightHarmonics(kHeight).of(change);
  const std::vector<SplitRow> more = t.turned(change, kStep), less = t.turned(change, -kStep);
  double error = 0, size = 0, irradiance_alone = 0;
  for (size_t i = 0; i < kRows; ++i) {
    const float d = at_corners(t.x.diffuse, rows[i].vertices, rows[i].barycentric).x;
    const double want = double(d) * (more[i].diffuse_light.x - less[i].diffuse_light.x) / (2 * kStep),
                 got = (grad.rows[i].gain * dot(grad.rows[i].d_light, harmonics_of_change)).x;
    error += square(got - want);
    size += square(want);
    irradiance_alone += square(double(d));
  }
  EXPECT_GT(std::sqrt(size / irradiance_alone), 0.02);  // the light's change matters
  EXPECT_LT(std::sqrt(error / size), 0.05);  // the light is smoothed a little before it is gathered
}

TEST(TurningIrradiance, NeedsOnlyTheVerticesAtRows) {
  Turning t;
  t.rows.resize(20);
  std::vector<uint8_t> at_rows(t.x.diffuse.size(), 0);
  for (const SplitRow& row : t.rows)
    for (const uint32_t v : row.vertices) at_rows[v] = 1;
  at_rows[0] = 1;  // corner of the rows' far points
  std::vector<SplitRow> rows = t.rows, few = t.rows;
  TurningIrradiance(t.transport, t.turns, kHeight).turn(t.x, t.materials, rows);
  const std::vector<Vec3f> all = split_irradiance(t.transport, t.x, t.materials, kHeight, &t.turns),
                           of_few = TurningIrradiance(t.transport, t.turns, kHeight, at_rows)
                                        .turn(t.x, t.materials, few)
                                        .irradiance;
  for (size_t v = 0; v < all.size(); ++v) EXPECT_EQ(length(of_few[v] - all[v] * float(at_rows[v])), 0);
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(length(few[i].diffuse_light - rows[i].diffuse_light), 0);
    EXPECT_EQ(length(few[i].far_diffuse_light - rows[i].far_diffuse_light), 0);
  }
}

// The diffuse light of a sample is its irradiance over the mean, so that it does not depend on the light's
// strength.
TEST(TurningIrradiance, IsOneUnderUniformLight) {
  Turning t;
  t.x.light = harmonic_light(5, 1.7f, 0);
  for (Vec3f& d : t.x.diffuse) d = {0, 0, 0};
  std::vector<SplitRow> rows = t.rows;
  TurningIrradiance(t.transport, t.turns, kHeight).turn(t.x, t.materials, rows);
  for (const SplitRow& r : rows) EXPECT_NEAR(r.diffuse_light.x, 1, 0.01f);
}

}  // namespace
}  // namespace cei3d
