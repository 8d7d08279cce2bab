// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "core/base/error.h"
#include "engine/edit/deform.h"
#include "engine/edit/part_vertices.h"
#include "engine/edit/remove.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

constexpr float kRadius = 0.6f;

// A sphere with a part "cap", its points around +z, and a part "all".
Scene ball() {
  Scene s;
  s.normalization = {{1, 2, 3}, 0.5};
  FieldConfig albedo;
  albedo.encoding.levels = 2;
  s.albedo = std::make_shared<Field>(albedo, 2);
  Mesh mesh = sphere_mesh(kRadius, 5);
  Region::Points cap, all;
  for (const Vec3f p : mesh.positions) {
    for (Region::Points* points : {&cap, &all}) {
      if (points == &cap && p.z < 0.35f) continue;
      points->positions.push_back(p);
      points->normals.push_back(normalize(p));
      points->reach.push_back(0.02f);
    }
  }
  std::vector<uint8_t> visibility(mesh.positions.size() * (kSkyDirections / 8), 0xff);
  s.surface = std::make_shared<Surface>(std::move(mesh), std::move(visibility));
  for (auto& [name, points] : {std::pair{"cap", cap}, {"all", all}}) {
    EditLayer layer;
    layer.id = name;
    layer.part = name;
    layer.region = Region(points);
    s.layers.push_back(layer);
  }
  return s;
}

class ShapeEdits : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { scene_ = new Scene(ball()); }
  static void TearDownTestSuite() { delete scene_; }

  static const Mesh& mesh() { return scene_->surface->mesh(); }
  static DeformResult drag(const DeformRequest& r) {
    Progress quiet;
    return deform(make_device(), *scene_, r, quiet);
  }
  static RemoveResult remove(const std::string& part) {
    Progress quiet;
    return remove_part(make_device(), *scene_, {"0001-remove", part}, quiet);
  }
  template <class F>
  static std::string error_of(F f) {
    try {
      f();
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }

  static inline Scene* scene_;
  static constexpr Vec3f kTop{0, 0, kRadius}, kUp{0, 0, kRadius + 0.2f};
};

TEST_F(ShapeEdits, TheHandleArrivesAndWhatIsOutsideTheRadiusStays) {
  const DeformResult r = drag({"0001-deform", {{kTop, kUp}}, 0.4f, ""});
  const Reshape& change = *r.layer.reshape;
  const Mesh after = apply(mesh(), change);
  EXPECT_EQ(r.report.vertices, change.moved.size());
  EXPECT_NEAR(r.report.farthest, 0.2f, 0.02f);
  for (size_t v = 0; v < after.positions.size(); ++v) {
    const Vec3f p = mesh().positions[v];
    const float arc = kRadius * std::acos(clamp(p.z / kRadius, -1.0f, 1.0f));
    if (arc > 0.41f) {
      EXPECT_EQ(std::memcmp(&after.positions[v], &p, sizeof p), 0);
      EXPECT_EQ(std::memcmp(&after.normals[v], &mesh().normals[v], sizeof p), 0);
    }
    if (arc < 0.05f) {
      EXPECT_NEAR(length(after.positions[v] - (p + (kUp - kTop))), 0, 1e-6f);
    }
  }
}

TEST_F(ShapeEdits, TheHillHasNoSpikeAndNoCrease) {
  const DeformResult r = drag({"0001-deform", {{kTop, kUp}}, 0.4f, ""});
  const Mesh after = apply(mesh(), *r.layer.reshape);
  // Neighboring triangles: on the ball they meet at about 0.05, on the steepest hill some times more.
  float worst = 0;
  std::map<std::pair<uint32_t, uint32_t>, Vec3f> normals;
  for (const auto& t : after.triangles) {
    const auto& p = after.positions;
    const Vec3f n = normalize(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    for (int k = 0; k < 3; ++k) normals[{t[k], t[(k + 1) % 3]}] = n;
  }
  for (const auto& [e, n] : normals)
    worst = max(worst, std::acos(clamp(dot(n, normals.at({e.second, e.first})), -1.0f, 1.0f)));
  EXPECT_LT(worst, 0.35f);
}

TEST_F(ShapeEdits, NormalsAreThoseOfTheNewShape) {
  const DeformResult r = drag({"0001-deform", {{kTop, kUp}}, 0.4f, ""});
  Mesh after = apply(mesh(), *r.layer.reshape);
  const std::vector<Vec3f> given = std::move(after.normals);
  after.normals.clear();
  const Surface fresh(std::move(after), std::vector<uint8_t>(given.size() * (kSkyDirections / 8), 0));
  for (size_t v = 0; v < given.size(); ++v) EXPECT_GT(dot(given[v], fresh.mesh().normals[v]), 0.985f);
}

TEST_F(ShapeEdits, APartMovesAndTheRestStays) {
  const DeformResult r = drag({"0001-deform", {{kTop, kUp}}, std::nullopt, "cap"});
  EXPECT_GT(r.layer.reshape->moved.size(), 300u);
  for (const uint32_t v : r.layer.reshape->moved) EXPECT_GT(mesh().positions[v].z, 0.32f);
}

TEST_F(ShapeEdits, BadDragsSayWhatToDo) {
  const auto error = [&](DeformRequest r) { return error_of([&] { drag(r); }); };
  EXPECT_THAT(error({"", {{{0, 0, 0.3f}, kUp}}, 0.4f, ""}),
              HasSubstr("There is no surface at 1,2,3.6; the nearest is at"));
  EXPECT_THAT(error({"", {{kTop, kTop}}, 0.4f, ""}), HasSubstr("no length"));
  EXPECT_THAT(error({"", {{kTop, {0, 0, 1.2f}}}, 0.4f, ""}),
              HasSubstr("outside the sphere of radius 2 around 1,2,3"));
  EXPECT_THAT(error({"", {{kTop, {0, 0.9f, 0.43f}}}, 1.0f, ""}), HasSubstr("outside the sphere"));
  EXPECT_THAT(error({"", {{kTop, {0, 0, NAN}}}, 0.4f, ""}), HasSubstr("finite"));
  EXPECT_THAT(error({"", {{kTop, kUp}}, 9.0f, ""}), HasSubstr("whole object would move"));
  EXPECT_THAT(error({"", {{kTop, kUp}}, 1e-3f, ""}), HasSubstr("give a larger radius"));
  EXPECT_THAT(error({"", {{kTop, kUp}}, -1.0f, ""}), HasSubstr("more than 0"));
  EXPECT_THAT(error({"", {{kTop, kUp}}, 0.4f, "ear"}), HasSubstr("no part 'ear'; there are 'all', 'cap'"));
  EXPECT_THAT(error({"", {{{0, 0, -kRadius}, kTop}}, 0.4f, "cap"}), HasSubstr("is not on part 'cap'"));
}

TEST_F(ShapeEdits, SeveralHandlesArriveAtOnceAndPinsStay) {
  const Vec3f side{kRadius, 0, 0}, between = normalize(Vec3f{1, 0, 1}) * kRadius;
  DeformRequest r{"0001-deform", {{kTop, kUp}, {side, side + Vec3f{0.15f, 0, 0}}}, 0.7f, ""};
  const auto moved_by = [&](const DeformRequest& request, Vec3f at) {
    const Mesh after = apply(mesh(), *drag(request).layer.reshape);
    size_t nearest = 0;
    for (size_t v = 0; v < after.positions.size(); ++v)
      if (length(mesh().positions[v] - at) < length(mesh().positions[nearest] - at)) nearest = v;
    return length(after.positions[nearest] - mesh().positions[nearest]);
  };
  EXPECT_NEAR(moved_by(r, kTop), 0.2f, 1e-5f);
  EXPECT_NEAR(moved_by(r, side), 0.15f, 1e-5f);
  EXPECT_GT(moved_by(r, between), 0.02f);
  r.pins = {between};
  EXPECT_EQ(moved_by(r, between), 0);
  EXPECT_NEAR(moved_by(r, kTop), 0.2f, 1e-5f);
}

TEST_F(ShapeEdits, ATurnedHandleTakesItsSurroundingsAlong) {
  DeformRequest r{"0001-deform", {{kTop, kTop, {0, 0, kPi / 2}}}, 0.5f, ""};
  const Mesh after = apply(mesh(), *drag(r).layer.reshape);
  size_t checked = 0;
  for (size_t v = 0; v < after.positions.size(); ++v) {
    const Vec3f p = mesh().positions[v], q = after.positions[v];
    if (kRadius * std::acos(clamp(p.z / kRadius, -1.0f, 1.0f)) > 0.07f) continue;
    EXPECT_NEAR(length(q - Vec3f{-p.y, p.x, p.z}), 0, 1e-5f);
    ++checked;
  }
  EXPECT_GT(checked, 5u);
}

TEST_F(ShapeEdits, BadPinsSayWhatToDo) {
  DeformRequest r{"", {{kTop, kUp}}, 0.4f, ""};
  r.pins = {{0, 0, 0.1f}};
  EXPECT_THAT(error_of([&] { drag(r); }), HasSubstr("Pin a point of the surface"));
  EXPECT_THAT(error_of([&] { drag({"", {}, 0.4f, ""}); }), HasSubstr("needs a point to drag"));
}

TEST_F(ShapeEdits, ARemovedPartIsGoneAndClosed) {
  const RemoveResult r = remove("cap");
  EXPECT_EQ(r.report.holes, 1u);
  EXPECT_EQ(r.report.pieces, 1u);
  const Mesh after = apply(mesh(), *r.layer.reshape);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : after.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [e, n] : edges) EXPECT_EQ(n + 10 * edges.count({e.second, e.first}), 11);
  for (const auto& t : after.triangles)
    for (const uint32_t v : t) EXPECT_LT(after.positions[v].z, 0.5f);
}

TEST_F(ShapeEdits, AFartherDragOfADraggedPartMovesTheSameMatter) {
  const DeformResult first = drag({"0001-deform", {{kTop, kUp}}, std::nullopt, "cap"});
  const Scene once = with_layer(*scene_, first.layer);
  EXPECT_EQ(part_vertices(once, "cap"), part_vertices(*scene_, "cap"));
  Progress quiet;
  const DeformResult second = deform(
      make_device(), once, {"0002-deform", {{kUp, {0.1f, 0, kRadius + 0.2f}}}, std::nullopt, "cap"}, quiet);
  EXPECT_EQ(second.layer.reshape->moved, first.layer.reshape->moved);
}

TEST_F(ShapeEdits, APatchCanBeDraggedAndIsNoneOfTheParts) {
  const RemoveResult gone = remove("cap");
  const Scene flat = with_layer(*scene_, gone.layer);
  const std::vector<uint8_t> cap = part_vertices(flat, "cap");
  ASSERT_EQ(cap.size(), mesh().positions.size() + gone.layer.reshape->added_positions.size());
  EXPECT_EQ(std::count(cap.begin() + long(mesh().positions.size()), cap.end(), 1), 0);
  uint32_t top = 0;
  const std::vector<Vec3f>& added = gone.layer.reshape->added_positions;
  for (uint32_t i = 0; i < added.size(); ++i)
    if (std::hypot(added[i].x, added[i].y) < std::hypot(added[top].x, added[top].y)) top = i;
  Progress quiet;
  const DeformResult r =
      deform(make_device(), flat, {"0002-deform", {{added[top], {0, 0, kRadius}}}, 0.3f, ""}, quiet);
  const Scene hill = with_layer(flat, r.layer);
  EXPECT_NEAR(hill.surface->mesh().positions[mesh().positions.size() + top].z, kRadius, 1e-5f);
}

TEST_F(ShapeEdits, WhatCannotBeRemovedIsSaid) {
  EXPECT_THAT(error_of([&] { remove("all"); }), HasSubstr("'all' is the whole object"));
  EXPECT_THAT(error_of([&] { remove("lid"); }), HasSubstr("no part 'lid'; there are 'all', 'cap'"));
}

}  // namespace
}  // namespace cei3d
