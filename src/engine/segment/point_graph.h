// SPDX-License-Identifier: Apache-2.0
// Handler points and which of them are neighbors on the surface: what a part is grown on.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/shape/handlers.h"

namespace cei3d {

struct GraphEdge {
  uint32_t a = 0, b = 0;  // points, a < b
  // How unlike the two are, in Oklab units: a hue 0.01 away is just visible; black to white is kLightness.
  float length = 0;  // spacings
  float color = 0;   // of their colors
  float crease = 0;  // of the surface between them, see kCreaseStep
  float step() const { return std::hypot(color, crease); }
};

struct PointGraph {
  std::vector<Vec3f> colors;     // #N, Oklab with the lightness times kLightness
  std::vector<GraphEdge> edges;  // each pair once, ordered by a, then b
};

// What shading is left in reconstructed base colors is lightness: dark grooves, bright rims. Hue tells more.
inline constexpr float kLightness = 0.4f;

// A concave crease counts like a difference of color, this much for each radian: objects are made of parts
// that meet in creases. [the minima rule: Hoffman and Richards 1984]
inline constexpr float kCreaseStep = 0.03f;

// Points are neighbors within two spacings, on the same side of the surface. base_colors: #N, linear.
PointGraph point_graph(const HandlerPoints&, std::span<const Vec3f> base_colors);

}  // namespace cei3d
