// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/reshape.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

// Two triangles that share an edge.
Mesh square_mesh() {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  m.normals.assign(4, {0, 0, 1});
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

Reshape lift_and_replace() {
  Reshape r;
  r.moved = {2};
  r.positions = {{1, 1, 0.5f}};
  r.normals = {{0, 0, -1}};
  r.gradients = {{1, 0, 0, 0, 1, 0, 0, 0, 2}};
  r.removed = {0};
  r.added_positions = {{0.5f, -1, 0}};
  r.added_normals = {{0, 1, 0}};
  r.added_colors = {{0.1f, 0.2f, 0.3f}};
  r.added_triangles = {{0, 4, 1}};
  r.rim = {0, 1};
  r.rim_colors = {{0.4f, 0.5f, 0.6f}, {0.7f, 0.8f, 0.9f}};
  return r;
}

TEST(Reshape, MovesRemovesAndAdds) {
  const Mesh m = apply(square_mesh(), lift_and_replace());
  ASSERT_EQ(m.positions.size(), 5u);
  EXPECT_EQ(m.positions[2].z, 0.5f);
  EXPECT_EQ(m.normals[2].z, -1);
  EXPECT_EQ(m.positions[1].x, 1);
  EXPECT_EQ(m.positions[4].y, -1);
  EXPECT_EQ(m.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 2, 3}, {0, 4, 1}}));
}

TEST(Reshape, OfNothingLeavesTheMesh) {
  const Mesh before = square_mesh(), after = apply(before, {});
  EXPECT_TRUE(Reshape{}.empty());
  EXPECT_EQ(after.triangles, before.triangles);
  for (size_t v = 0; v < 4; ++v) EXPECT_EQ(after.positions[v].x, before.positions[v].x);
}

TEST(Reshape, LoadGivesWhatWasSaved) {
  for (const Reshape& r : {lift_and_replace(), Reshape{}}) {
    Tensors tensors, again;
    Json head, head_again;
    save_reshape(r, tensors, head);
    save_reshape(load_reshape(tensors_from_bytes(tensors_to_bytes(tensors), "test"), head), again,
                 head_again);
    EXPECT_EQ(tensors_to_bytes(tensors), tensors_to_bytes(again));
    EXPECT_EQ(head, head_again);
  }
}

TEST(Reshape, OfAnotherMeshIsAnError) {
  Reshape vertex = lift_and_replace(), triangle = vertex, unsorted = vertex, short_list = vertex,
          corner = vertex, rim = vertex;
  vertex.moved = {4};
  triangle.removed = {2};
  unsorted.removed = {1, 0};
  short_list.normals.clear();
  corner.added_triangles = {{0, 1, 5}};
  rim.added_triangles = {{0, 2, 4}};
  for (const Reshape& r : {vertex, triangle, unsorted, short_list, corner, rim})
    EXPECT_THROW(apply(square_mesh(), r), Error);
}

}  // namespace
}  // namespace cei3d
