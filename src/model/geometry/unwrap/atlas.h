// SPDX-License-Identifier: Apache-2.0
// A texture atlas of a mesh: its surface cut into charts, each laid flat, all packed into the unit square.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// Texture coordinates are glTF's: (0, 0) is the upper left corner of the image, v grows downwards. No chart
// is mirrored: on the image, triangles are counter-clockwise.
struct Atlas {
  std::vector<uint32_t> vertex;                    // #V, the mesh's vertex
  std::vector<Vec2f> uv;                           // #V
  std::vector<std::array<uint32_t, 3>> triangles;  // #F, those of the mesh in their order
  std::vector<uint32_t> chart;                     // #F
  uint32_t charts = 0;
};

// Cuts, flattens and packs for a texture of texels x texels. Empty texels between charts: texels / 256, so
// that charts do not mix in mip levels down to 256 texels. Where a chart would be flipped, overlap itself or
// be stretched by more than kMaxStretch, it is cut in two, at worst down to single triangles; no texel's
// center lies in two triangles. Charts are joined where their union lies nearly flat. Errors: no triangles
// with an area; so many charts that the texture has no room for them.
Atlas unwrap(const Mesh& mesh, int texels);

inline constexpr double kMaxStretch = 1.4;

struct AtlasQuality {
  double used = 0;         // share of the square that triangles cover
  double stretch = 0;      // L2 [Sander et al. 2001], 1: isometric
  size_t flipped = 0;      // triangles
  size_t overlapping = 0;  // texels whose centers lie within more than one triangle
};
AtlasQuality quality_of(const Mesh& mesh, const Atlas& atlas, int texels);

}  // namespace cei3d
