// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

TEST(Adjacency, EdgesOfAClosedMeshAreEachThereOnce) {
  const Mesh mesh = sphere_mesh(1, 3);
  std::set<Edge> expected;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      expected.insert({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  std::vector<Edge> edges = edges_of(mesh.triangles);
  EXPECT_EQ(edges.size(), 3 * mesh.triangles.size() / 2);
  EXPECT_EQ(std::set<Edge>(edges.begin(), edges.end()), expected);
}

TEST(Adjacency, EdgesJoinTheirEndsInTheirOrder) {
  const std::vector<Edge> edges{{0, 3}, {0, 1}, {1, 3}};
  const VertexLists joined = joined_by(5, edges);
  const auto of = [&](uint32_t v) { return std::vector<uint32_t>(joined.of(v).begin(), joined.of(v).end()); };
  EXPECT_EQ(of(0), (std::vector<uint32_t>{3, 1}));
  EXPECT_EQ(of(1), (std::vector<uint32_t>{0, 3}));
  EXPECT_EQ(of(2), std::vector<uint32_t>{});
  EXPECT_EQ(of(3), (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(of(4), std::vector<uint32_t>{});
}

TEST(Adjacency, VerticesOfAClosedMeshAreJoinedToTheirNeighbors) {
  const Mesh mesh = sphere_mesh(1, 3);
  const size_t n = mesh.positions.size();
  const VertexLists joined = joined_by(n, edges_of(mesh.triangles)),
                    neighbors = neighbors_of(n, mesh.triangles);
  for (uint32_t v = 0; v < n; ++v) {
    std::vector<uint32_t> list(joined.of(v).begin(), joined.of(v).end());
    std::sort(list.begin(), list.end());
    EXPECT_TRUE(std::equal(list.begin(), list.end(), neighbors.of(v).begin(), neighbors.of(v).end())) << v;
  }
}

}  // namespace
}  // namespace cei3d
