// SPDX-License-Identifier: Apache-2.0
// Distances to points of a sphere against its own, and a ball whose field follows a dragged point.
#include "engine/edit/refit_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "engine/edit/deform.h"
#include "engine/edit/point_distance.h"
#include "engine/render/render.h"
#include "model/field/test_learned_field.h"
#include "model/geometry/mesh/surface_nets.h"
#include "model/geometry/mesh/test_meshes.h"
#include "model/geometry/shape/trace_field.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.6f;

HandlerPoints points_of(const Mesh& mesh) {
  HandlerPoints p;
  p.positions = mesh.positions;
  for (const Vec3f x : mesh.positions) p.normals.push_back(normalize(x));
  p.spacing = 0.02f;
  p.footprints.assign(p.positions.size(), p.spacing);
  return p;
}

TEST(PointDistance, IsThatOfTheSphereNearItAndFarFromIt) {
  const PointDistance distance(points_of(sphere_mesh(kRadius, 6)));
  for (uint64_t i = 0; i < 500; ++i) {
    Rng rng(1, 0, i);
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    const float want = 0.35f * (2 * rng.uniform() - 1);
    EXPECT_NEAR(distance.signed_distance(d * (kRadius + want)), want, 0.001f + 0.03f * std::abs(want))
        << want;
    EXPECT_GE(distance.l1_distance(d * (kRadius + want)), 0.99f * std::abs(want) - 1e-3f);
  }
}

TEST(PointDistance, L1IsTheLeastSumOfDifferences) {
  HandlerPoints p = points_of(sphere_mesh(kRadius, 4));
  p.spacing = 0.08f;
  const PointDistance distance(p);
  for (uint64_t i = 0; i < 100; ++i) {
    Rng rng(2, 0, i);
    const Vec3f x =
        normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}) * (0.5f + 0.2f * rng.uniform());
    float smallest = 9;
    for (const Vec3f h : p.positions)
      smallest = std::min(smallest, std::abs(x.x - h.x) + std::abs(x.y - h.y) + std::abs(x.z - h.z));
    EXPECT_NEAR(distance.l1_distance(x), smallest, 1e-6f);
  }
}

class FieldDeform : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Device device = make_device();
    auto* s = new Scene;
    s->sdf = std::make_shared<const Field>(
        learned_distances(device, kRadius, 0.03f, [](Vec3f x) { return length(x) - kRadius; }));
    FieldConfig albedo;
    albedo.encoding.levels = 3;
    albedo.output_activation = Activation::sigmoid;
    s->albedo = std::make_shared<Field>(albedo, 2);
    Mesh mesh = extract_mesh(device, *s->sdf, {64});
    std::vector<uint8_t> visibility(mesh.positions.size() * (kSkyDirections / 8), 0xff);
    s->surface = std::make_shared<Surface>(std::move(mesh), std::move(visibility));
    scene_ = s;
    field_ = new DeformResult(deformed(drag(DeformedGeometry::field)));
  }
  static void TearDownTestSuite() {
    delete field_;
    delete scene_;
  }
  static DeformRequest drag(DeformedGeometry geometry) {
    DeformRequest r{"0001-deform", {{{0, 0, kRadius}, {0, 0, kRadius + 0.15f}}}, 0.5f, ""};
    r.geometry = geometry;
    r.options.refit.steps = 250;
    r.options.refit.table_rate = 1e-2f;  // a small field has to change more
    return r;
  }
  static DeformResult deformed(const DeformRequest& r) {
    Progress quiet;
    return deform(make_device(), *scene_, r, quiet);
  }
  static inline const Scene* scene_;
  static inline const DeformResult* field_;  // with a field of its own
};

std::vector<Ray> rays_from_above() {
  std::vector<Ray> rays;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      rays.push_back({{-0.6f + 0.03f * float(i), -0.6f + 0.03f * float(j), 2}, {0, 0, -1}});
  return rays;
}

TEST_F(FieldDeform, ZeroSetIsTheDeformedMesh) {
  const DeformResult mesh = deformed(drag(DeformedGeometry::mesh)), &field = *field_;
  ASSERT_TRUE(field.layer.sdf);
  ASSERT_TRUE(field.report.misfit);
  EXPECT_LT(*field.report.misfit, 0.006f * kRadius);  // of an object of this radius
  EXPECT_NEAR(field.report.farthest, 0.15f, 0.01f);
  // The field alone, without any mesh, met by rays; the mesh is what it was fitted to.
  const Device device = make_device();
  const Scene bent = with_layer(*scene_, mesh.layer);
  const std::vector<Ray> rays = rays_from_above();
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> want = trace_rays(device, bent, rays, ray_of_hit);
  const std::vector<FieldTrace> got = trace_field(device, *field.layer.sdf, rays);
  double sum = 0;
  for (size_t k = 0; k < want.size(); ++k) {
    const FieldTrace& t = got[ray_of_hit[k]];
    ASSERT_TRUE(t.hit);
    sum += std::min(std::abs(2 - t.depth - want[k].position.z), 0.02f) / double(want.size());
  }
  EXPECT_LT(sum, 0.004);
}

TEST_F(FieldDeform, HitsLieOnItsFieldAndKnowWhereTheyWere) {
  const Device device = make_device();
  const DeformResult& field = *field_;
  const Scene hill = with_layer(*scene_, field.layer);
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, hill, rays_from_above(), ray_of_hit);
  const std::vector<float> values = first_output(device, *field.layer.sdf, positions_of(hits));
  size_t moved = 0;
  for (size_t k = 0; k < hits.size(); ++k) {
    if (hill.shape_versions.back()->shaped_in(hits[k].triangle) == 0) continue;
    ++moved;
    EXPECT_NEAR(values[k], 0, 2e-3f);
    EXPECT_NEAR(length(in_version(hill.shape_versions, hits[k], 0).position), kRadius, 0.02f);
  }
  EXPECT_GT(moved, 100u);
}

// Unchanged surface does not notice: bit for bit.
TEST_F(FieldDeform, SurfaceOutsideTheRadiusStays) {
  const Device device = make_device();
  const Scene hill = with_layer(*scene_, field_->layer);
  std::vector<Ray> rays;
  for (Ray r : rays_from_above()) rays.push_back({{r.origin.x, r.origin.y, -2}, {0, 0, 1}});
  std::vector<uint32_t> a, b;
  const std::vector<Hit> before = trace_rays(device, *scene_, rays, a),
                         after = trace_rays(device, hill, rays, b);
  ASSERT_EQ(a, b);
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].position.z, after[i].position.z);
    EXPECT_EQ(before[i].normal.x, after[i].normal.x);
  }
}

// As printed, the loss compares with distances that are positive on both sides.
TEST_F(FieldDeform, UnsignedDistancesLeaveNoInside) {
  DeformRequest r = drag(DeformedGeometry::field);
  r.options.refit.distance = SurfaceDistance::l1;
  try {
    deformed(r);
    ADD_FAILURE() << "passed for a shape";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("use signed ones"));
  }
}

}  // namespace
}  // namespace cei3d
