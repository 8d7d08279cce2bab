// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/atlas.h"

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "model/geometry/unwrap/charts.h"
#include "model/geometry/unwrap/face_graph.h"
#include "model/geometry/unwrap/flatten.h"
#include "model/geometry/unwrap/join_charts.h"
#include "model/geometry/unwrap/pack.h"
#include "model/geometry/unwrap/raster.h"

namespace cei3d {
namespace {

constexpr int kMipFloor = 256;  // texels of the smallest mip level in which charts stay apart

std::vector<FlatChart> flat_charts(const FaceGraph& graph, const Flattener& flattener) {
  const std::vector<std::vector<uint32_t>> charts = grow_charts(graph).faces();
  std::vector<std::vector<FlatChart>> flat(charts.size());
  parallel_for(int(charts.size()), [&](int c) { flattener.flatten(charts[c], kMaxStretch, flat[c]); });
  std::vector<FlatChart> out;
  for (auto& some : flat) std::move(some.begin(), some.end(), std::back_inserter(out));
  return out;
}

void add_chart(const FlatChart& chart, std::span<const Vec2d> uv, Atlas& out) {
  const uint32_t first = uint32_t(out.vertex.size());
  for (size_t v = 0; v < uv.size(); ++v) {
    out.vertex.push_back(chart.vertex[v]);
    out.uv.push_back({float(uv[v].x), float(1 - uv[v].y)});
  }
  for (size_t f = 0; f < chart.faces.size(); ++f) {
    const auto [a, b, c] = chart.flat.triangles[f];
    out.triangles[chart.faces[f]] = {first + a, first + b, first + c};
    out.chart[chart.faces[f]] = out.charts;
  }
  ++out.charts;
}

Vec2f texel_of(const Atlas& atlas, uint32_t v, int texels) { return atlas.uv[v] * float(texels); }

// Share of the texture. A few large charts that fill less of it may fit worse than many small ones.
constexpr double kWellUsed = 0.6;

// Calls use(x, y, face) for the texels whose centers lie within a triangle.
template <class Use>
void for_each_owned_texel(const Atlas& atlas, int texels, const Use& use) {
  for (size_t f = 0; f < atlas.triangles.size(); ++f) {
    const auto [i, j, k] = atlas.triangles[f];
    const Vec2f a = texel_of(atlas, i, texels), b = texel_of(atlas, j, texels),
                c = texel_of(atlas, k, texels);
    for_each_inner_texel(a, b, c, texels, texels, [&](int x, int y) { use(x, y, f); });
  }
}

// Charts that have a texel in two triangles.
std::vector<bool> overlapping_charts(const Atlas& atlas, int texels) {
  std::vector<bool> seen(size_t(texels) * texels, false), out(atlas.charts, false);
  for_each_owned_texel(atlas, texels, [&](int x, int y, size_t f) {
    const size_t texel = size_t(y) * texels + x;
    if (seen[texel]) out[atlas.chart[f]] = true;
    seen[texel] = true;
  });
  return out;
}

Atlas atlas_of(const Mesh& mesh, const std::vector<FlatChart>& charts, int texels) {
  std::vector<FlatPiece> pieces;
  for (const FlatChart& c : charts) pieces.push_back(c.flat);
  const auto uv = packed(pieces, {texels, std::max(2, texels / kMipFloor)});
  Atlas out;
  out.triangles.resize(mesh.triangles.size());
  out.chart.resize(mesh.triangles.size());
  for (size_t c = 0; c < charts.size(); ++c) add_chart(charts[c], uv[c], out);
  return out;
}

// Cuts charts that overlap themselves at the density of the texture: folds thinner than the flattener sees.
Atlas without_overlaps(const Mesh& mesh, const Flattener& flattener, std::vector<FlatChart> charts,
                       int texels) {
  while (true) {
    Atlas out = atlas_of(mesh, charts, texels);
    const std::vector<bool> overlapping = overlapping_charts(out, texels);
    std::vector<FlatChart> cut;
    for (size_t c = 0; c < charts.size(); ++c)
      if (overlapping[c] && charts[c].faces.size() > 1)
        flattener.flatten_halves(charts[c].faces, kMaxStretch, cut);
      else
        cut.push_back(std::move(charts[c]));
    if (cut.size() == charts.size()) return out;
    charts = std::move(cut);
  }
}

}  // namespace

Atlas unwrap(const Mesh& mesh, int texels) {
  if (mesh.triangles.empty()) fail("There is no surface to lay a texture on: the mesh is empty.");
  const FaceGraph graph = face_graph(mesh.positions, mesh.triangles);
  const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
  if (!(area > 0)) fail("The surface has no triangles with an area, so it cannot have a texture.");
  const Flattener flattener(mesh, graph, double(texels) / std::sqrt(area));
  const std::vector<FlatChart> small = flat_charts(graph, flattener);
  Atlas few = without_overlaps(mesh, flattener, joined(graph, flattener, small), texels);
  const double used = quality_of(mesh, few, texels).used;
  if (used >= kWellUsed) return few;
  Atlas many = without_overlaps(mesh, flattener, small, texels);
  return quality_of(mesh, many, texels).used > used ? many : few;
}

AtlasQuality quality_of(const Mesh& mesh, const Atlas& atlas, int texels) {
  AtlasQuality q;
  Patch2d all;
  std::vector<Vec2d> uv;
  for (size_t v = 0; v < atlas.vertex.size(); ++v) {
    all.points.push_back(mesh.positions[atlas.vertex[v]]);
    uv.push_back({atlas.uv[v].x, 1 - double(atlas.uv[v].y)});
  }
  all.triangles = atlas.triangles;
  q.stretch = stretch_of(all, uv).l2;
  std::vector<uint8_t> owners(size_t(texels) * texels, 0);
  for (const auto& [a, b, c] : atlas.triangles) {
    const double area = signed_area(uv[b] - uv[a], uv[c] - uv[a]) / 2;
    q.used += area;
    q.flipped += area < 0;
  }
  for_each_owned_texel(atlas, texels, [&](int x, int y, size_t) {
    uint8_t& n = owners[size_t(y) * texels + x];
    q.overlapping += n++ == 1;
  });
  return q;
}

}  // namespace cei3d
