// SPDX-License-Identifier: Apache-2.0
// Edges of a mesh, neighbors of its vertices, and the cotangent weights of the discrete Laplacian.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// One list per vertex, stored one after the other.
struct VertexLists {
  std::vector<uint32_t> start;  // #V + 1
  std::vector<uint32_t> items;  // list of v: items[start[v] .. start[v + 1])

  std::span<const uint32_t> of(uint32_t v) const {
    return std::span(items).subspan(start[v], start[v + 1] - start[v]);
  }
};

// Triangles around each vertex, ascending.
VertexLists triangles_around(size_t vertices, std::span<const std::array<uint32_t, 3>> triangles);
// Vertices that share an edge with each vertex, ascending.
VertexLists neighbors_of(size_t vertices, std::span<const std::array<uint32_t, 3>> triangles);

using Edge = std::array<uint32_t, 2>;
// The edges (a, b), a < b, that a triangle runs through from a to b, in the order of the triangles. In a
// closed mesh these are all edges, each once.
std::vector<Edge> edges_of(std::span<const std::array<uint32_t, 3>> triangles);
// Vertices that one of these edges joins to each vertex, in the order of the edges.
VertexLists joined_by(size_t vertices, std::span<const Edge> edges);

// Cotangent weights, one for each item of `neighbors` (0.5 (cot a + cot b), the same in both directions), and
// the area of each vertex (a third of its triangles' areas). [Pinkall and Polthier 1993] Weights are clamped
// to [0.05, 5], so that the Laplacian stays positive definite on obtuse triangles and slivers do not
// dominate; areas are at least a tenth of their mean.
struct LaplaceWeights {
  std::vector<double> edge;    // #items
  std::vector<double> vertex;  // #V, sum of the vertex's edge weights
  std::vector<double> area;    // #V
};
LaplaceWeights laplace_weights(std::span<const Vec3f> positions,
                               std::span<const std::array<uint32_t, 3>> triangles,
                               const VertexLists& neighbors);

}  // namespace cei3d
