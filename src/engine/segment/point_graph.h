// SPDX-License-Identifier: Apache-2.0
// The graph of neighboring handler points, on which parts are grown.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/shape/handlers.h"

namespace cei3d {

struct GraphOptions {
  // Weight of lightness against hue: shading that remains in the reconstructed albedo (dark grooves, bright
  // rims) is mostly lightness.
  float lightness = 0.4f;
  // A concave crease counts as much as this difference of color per radian, because parts of objects meet in
  // concave creases. [the minima rule: Hoffman and Richards 1984]
  float crease = 0.03f;
};

struct GraphEdge {
  uint32_t a = 0, b = 0;  // points, a < b
  // Differences of the two points in Oklab units: a change of hue by 0.01 is just visible; black to white is
  // GraphOptions::lightness.
  float length = 0;  // distance, in spacings
  float color = 0;   // difference of colors
  float crease = 0;  // concavity of the surface between them, times GraphOptions::crease
  float step() const { return std::hypot(color, crease); }
};

struct PointGraph {
  std::vector<Vec3f> colors;     // #N, Oklab with the lightness times GraphOptions::lightness
  std::vector<GraphEdge> edges;  // each pair once, ordered by a, then b
};

// Points within two spacings on the same side of the surface are neighbors. albedo: #N, linear albedo.
PointGraph point_graph(const HandlerPoints&, std::span<const Vec3f> albedo, const GraphOptions& = {});

}  // namespace cei3d
