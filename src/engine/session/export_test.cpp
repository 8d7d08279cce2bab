// SPDX-License-Identifier: Apache-2.0
// Where the session puts an exported object, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_of.h"
#include "engine/io/ply.h"
#include "engine/session/test_edits.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ExportFiles : public EditTest {
 protected:
  ExportRequest to(const std::string& name) const {
    ExportRequest r;
    r.out = {temp_.path() / "exports" / name};
    r.texture = name.ends_with(".glb") ? std::optional(0) : std::nullopt;
    return r;
  }
  Mesh written(const ExportRequest& r) {
    session_.export_to(r, quiet_);
    return read_ply(r.out.front());
  }
  std::string refusal(const ExportRequest& r) {
    const Error e = error_of([&] { session_.export_to(r, quiet_); });
    EXPECT_EQ(e.code(), ErrorCode::usage) << e.what();
    return e.what();
  }
};

TEST_F(ExportFiles, APlyStandsWhereItIsAskedFor) {
  ExportRequest standing = to("standing.ply");
  standing.size = 0.3;
  standing.at_base = true;
  const Mesh as_captured = written(to("ball.ply")), mesh = written(standing);
  ASSERT_EQ(mesh.positions.size(), as_captured.positions.size());
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_NEAR(length(as_captured.positions[v]), kSphereRadius, 1e-5);
    const Vec3f from_center = mesh.positions[v] - Vec3f{0, 0.15f, 0};
    EXPECT_NEAR(length(from_center), 0.15f, 1e-5);
    EXPECT_NEAR(length(from_center * (1 / 0.15f) - mesh.normals[v]), 0, 1e-4);
  }
}

TEST_F(ExportFiles, LengthsBeyondReasonAreRefused) {
  for (const double scale : {1e300, 1e10, 1e-300, 0.0, -1.0, double(NAN), double(INFINITY)}) {
    ExportRequest r = to("ball.glb");
    r.unit_scale = scale;
    EXPECT_THAT(refusal(r), HasSubstr("Unit scale")) << scale;
  }
  for (const double size : {1e300, 1e-300, -1.0, double(NAN), double(INFINITY)}) {
    ExportRequest r = to("ball.glb");
    r.size = size;
    EXPECT_THAT(refusal(r), HasSubstr("Size")) << size;
  }
  EXPECT_FALSE(fs::exists(temp_.path() / "exports"));
}

TEST_F(ExportFiles, WhatNoFileHasAPlaceForIsRefused) {
  for (const char* name : {"ball.html", "ball.hdr", "ball.npy"}) {
    ExportRequest sized = to(name), scaled = to(name), moved = to(name), lit = to(name);
    sized.size = 0.3;
    scaled.unit_scale = 2;
    moved.at_base = true;
    lit.light = true;
    for (const ExportRequest& r : {sized, scaled, moved})
      EXPECT_THAT(refusal(r), HasSubstr("no place for size")) << name;
    EXPECT_THAT(refusal(lit), HasSubstr("holds it already")) << name;
  }
  ExportRequest points = to("points.ply");
  points.points = true;
  points.size = 0.3;
  EXPECT_THAT(refusal(points), HasSubstr("Points stay"));
  EXPECT_FALSE(fs::exists(temp_.path() / "exports"));
  ExportRequest several = to("ball.glb");
  several.out.push_back(temp_.path() / "exports/light.npy");
  several.unit_scale = 2;
  EXPECT_NO_THROW(session_.export_to(several, quiet_));
}

}  // namespace
}  // namespace cei3d
