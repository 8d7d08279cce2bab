// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/face_graph.h"

#include <algorithm>

namespace cei3d {
namespace {

using Triangles = std::span<const std::array<uint32_t, 3>>;

struct HalfEdge {
  uint32_t low, high, face;
  uint8_t edge;
  bool forward;  // from low to high
  bool same_edge(const HalfEdge& o) const { return low == o.low && high == o.high; }
  bool operator<(const HalfEdge& o) const {
    return low != o.low ? low < o.low : high != o.high ? high < o.high : face < o.face;
  }
};

std::vector<HalfEdge> sorted_edges(Triangles triangles) {
  std::vector<HalfEdge> out;
  out.reserve(triangles.size() * 3);
  for (size_t f = 0; f < triangles.size(); ++f)
    for (uint8_t k = 0; k < 3; ++k) {
      const uint32_t a = triangles[f][k], b = triangles[f][(k + 1) % 3];
      out.push_back({std::min(a, b), std::max(a, b), uint32_t(f), k, a < b});
    }
  std::sort(out.begin(), out.end());
  return out;
}

void join_faces(Triangles triangles, FaceGraph& graph) {
  graph.across.assign(triangles.size(), {kNoFace, kNoFace, kNoFace});
  const std::vector<HalfEdge> edges = sorted_edges(triangles);
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].same_edge(edges[i])) ++end;
    if (end - i == 2 && edges[i].forward != edges[i + 1].forward) {
      const HalfEdge &a = edges[i], &b = edges[i + 1];
      graph.across[a.face][a.edge] = b.face;
      graph.across[b.face][b.edge] = a.face;
    }
    i = end;
  }
}

// Slivers, whose own normals are rounding errors.
std::vector<uint32_t> measure_faces(std::span<const Vec3f> p, Triangles triangles, FaceGraph& graph) {
  constexpr float kThin = 1e-3f;  // ratio of the height of a thin triangle to its longest edge
  std::vector<uint32_t> slivers;
  for (size_t f = 0; f < triangles.size(); ++f) {
    const auto [a, b, c] = triangles[f];
    const Vec3f n = cross(p[b] - p[a], p[c] - p[a]);
    graph.edges.push_back({length(p[b] - p[a]), length(p[c] - p[b]), length(p[a] - p[c])});
    const float longest = *std::max_element(graph.edges[f].begin(), graph.edges[f].end());
    if (length(n) < kThin * longest * longest) slivers.push_back(uint32_t(f));
    graph.areas.push_back(length(n) / 2);
    graph.normals.push_back(normalize(n));
    graph.centers.push_back((p[a] + p[b] + p[c]) / 3.0f);
  }
  return slivers;
}

void smooth_slivers(std::span<const uint32_t> slivers, FaceGraph& graph) {
  std::vector<Vec3f> smooth;
  for (const uint32_t f : slivers) {
    Vec3f sum = graph.normals[f] * graph.areas[f];
    for (const uint32_t g : graph.across[f])
      if (g != kNoFace) sum += graph.normals[g] * graph.areas[g];
    smooth.push_back(length(sum) > 0 ? normalize(sum) : graph.normals[f]);
  }
  for (size_t i = 0; i < slivers.size(); ++i) graph.normals[slivers[i]] = smooth[i];
}

}  // namespace

FaceGraph face_graph(std::span<const Vec3f> positions, Triangles triangles) {
  FaceGraph graph;
  join_faces(triangles, graph);
  const std::vector<uint32_t> slivers = measure_faces(positions, triangles, graph);
  smooth_slivers(slivers, graph);
  return graph;
}

}  // namespace cei3d
