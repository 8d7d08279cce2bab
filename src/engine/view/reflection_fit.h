// SPDX-License-Identifier: Apache-2.0
// What the surface hides of the sky from the reflections of its vertices, and what it shows there instead:
// polynomials of the mirror direction, fitted to the program's own values over directions of view. They are
// closer to these values than what the packs "shape" and "vertex_light" (view_mesh.h) give, but they hold for
// one light and for the materials of the vertices, and take longer to make.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/render/lighting.h"
#include "engine/view/view_mesh.h"
#include "engine/view/visibility_harmonics.h"

namespace cei3d {

struct ReflectionFit {
  VisibilityTerms visibility{1};                 // share of the reflected sky that is not hidden
  std::array<Vec3f, kVisibilityTerms> object{};  // mean radiance of the surface over the lobe, linear
};

// Of the view's vertices, shaded with `look`: that of the vertices of the mesh, appearance_at() of
// vertex_hits(). Takes seconds, more for metals.
std::vector<ReflectionFit> reflection_fits(const Lighting&, const Surface&, const ViewMesh&,
                                           const Appearance& look);

// "reflections": visibility i8 [#V, 12], as that of "shape"; object i8 [#V, 28]: red, green and blue of the
// nine terms in units of the vertex' own scale, which comes last: the square of its 127th part times the
// head's object_scale.
std::string view_reflections(const std::vector<ReflectionFit>&);

}  // namespace cei3d
