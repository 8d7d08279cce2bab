// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/point_graph.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

// Angle by which the surface turns towards itself from p to q, radians; 0 where it is flat or convex.
float concavity(Vec3f p, Vec3f normal_p, Vec3f q, Vec3f normal_q) {
  return max(-dot(normal_q - normal_p, normalize(q - p)), 0.0f);
}

}  // namespace

PointGraph point_graph(const HandlerPoints& points, std::span<const Vec3f> albedo,
                       const GraphOptions& options) {
  const int n = int(points.positions.size());
  PointGraph graph;
  graph.colors.resize(n);
  std::vector<std::vector<GraphEdge>> of(n);  // edges to later points
  const float reach = 2.5f * points.spacing;
  const PointIndex index(points.positions, reach);
  parallel_ranges(n, 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      graph.colors[i] = oklab_from_linear(albedo[i]);
      graph.colors[i].x *= options.lightness;
    }
  });
  parallel_ranges(n, 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Vec3f p = points.positions[i], normal = points.normals[i];
      index.any_within(p, reach, [&](size_t k) {
        if (int(k) <= i || dot(points.normals[k], normal) <= 0) return false;
        const float color = length(graph.colors[k] - graph.colors[i]);
        const float crease = options.crease * concavity(p, normal, points.positions[k], points.normals[k]);
        of[i].push_back(
            {uint32_t(i), uint32_t(k), length(points.positions[k] - p) / points.spacing, color, crease});
        return false;
      });
      std::sort(of[i].begin(), of[i].end(), [](const GraphEdge& x, const GraphEdge& y) { return x.b < y.b; });
    }
  });
  for (const auto& edges : of) graph.edges.insert(graph.edges.end(), edges.begin(), edges.end());
  return graph;
}

}  // namespace cei3d
