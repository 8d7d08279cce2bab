// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/atlas.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "model/geometry/unwrap/charts.h"
#include "model/geometry/unwrap/conformal.h"
#include "model/geometry/unwrap/face_graph.h"
#include "model/geometry/unwrap/pack.h"
#include "model/geometry/unwrap/raster.h"

namespace cei3d {
namespace {

constexpr int kMipFloor = 256;  // texels of the smallest mip level in which charts stay apart

// A chart laid flat.
struct FlatChart {
  std::vector<uint32_t> faces;   // of the mesh
  std::vector<uint32_t> vertex;  // #points, of the mesh
  FlatPiece flat;
};

uint32_t root(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Lays out the faces of a mesh, one chart after the other.
class Flattener {
 public:
  Flattener(const Mesh& mesh, const FaceGraph& graph, double texels_per_length)
      : mesh_(mesh), graph_(graph), density_(texels_per_length) {}

  // One chart, or as many as it takes.
  void flatten(std::vector<uint32_t> faces, std::vector<FlatChart>& out) const {
    std::vector<std::vector<uint32_t>> open{std::move(faces)};
    while (!open.empty()) {
      std::vector<uint32_t> part = std::move(open.back());
      open.pop_back();
      FlatChart chart;
      const Patch2d patch = patch_of(part, chart.vertex);
      if (lay_flat(patch, chart.flat)) {
        chart.faces = std::move(part);
        out.push_back(std::move(chart));
      } else {
        for (auto& half : halves(part)) open.push_back(std::move(half));
      }
    }
  }

  void flatten_halves(const std::vector<uint32_t>& faces, std::vector<FlatChart>& out) const {
    for (auto& half : halves(faces)) flatten(std::move(half), out);
  }

 private:
  // Joins corners across the edges inside of the piece.
  Patch2d patch_of(std::span<const uint32_t> faces, std::vector<uint32_t>& vertex) const {
    std::vector<uint32_t> parent(faces.size() * 3);
    std::iota(parent.begin(), parent.end(), 0u);
    for (uint32_t i = 0; i < faces.size(); ++i)
      for (uint32_t k = 0; k < 3; ++k) join_across(faces, i, k, parent);
    Patch2d patch;
    std::vector<uint32_t> id(parent.size(), kNoFace);
    for (uint32_t i = 0; i < faces.size(); ++i) {
      patch.axis += graph_.normals[faces[i]] * graph_.areas[faces[i]];
      patch.triangles.emplace_back();
      for (uint32_t k = 0; k < 3; ++k) {
        uint32_t& v = id[root(parent, 3 * i + k)];
        if (v == kNoFace) {
          v = uint32_t(vertex.size());
          vertex.push_back(mesh_.triangles[faces[i]][k]);
          patch.points.push_back(mesh_.positions[vertex.back()]);
        }
        patch.triangles.back()[k] = v;
      }
    }
    patch.axis = normalize(patch.axis);
    return patch;
  }

  void join_across(std::span<const uint32_t> faces, uint32_t i, uint32_t k,
                   std::vector<uint32_t>& parent) const {
    const uint32_t g = graph_.across[faces[i]][k];
    const auto at = g == kNoFace ? faces.end() : std::lower_bound(faces.begin(), faces.end(), g);
    if (at == faces.end() || *at != g) return;
    const uint32_t j = uint32_t(at - faces.begin());
    const auto& mine = mesh_.triangles[faces[i]];
    const auto& other = mesh_.triangles[g];
    const auto corner_of = [&](uint32_t v) {
      return uint32_t(std::find(other.begin(), other.end(), v) - other.begin());
    };
    for (const uint32_t c : {k, (k + 1) % 3}) {
      const uint32_t a = root(parent, 3 * i + c), b = root(parent, 3 * j + corner_of(mine[c]));
      parent[std::max(a, b)] = std::min(a, b);
    }
  }

  bool lay_flat(const Patch2d& patch, FlatPiece& out) const {
    out.triangles = patch.triangles;
    for (const bool conformal : {true, false}) {
      out.points = conformal ? conformal_map(patch) : projection(patch);
      const Stretch s = stretch_of(patch, out.points);
      if (!s.flipped && s.l2 <= kMaxStretch && !overlaps_itself(out)) return true;
    }
    return patch.triangles.size() == 1;
  }

  // At twice the density that the texture will have.
  bool overlaps_itself(const FlatPiece& piece) const {
    Vec2d low = piece.points[0], high = low;
    for (const Vec2d& p : piece.points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    constexpr int kMax = 8192;
    const double scale = std::min(2 * density_, kMax / std::max({high.x - low.x, high.y - low.y, 1e-30}));
    const int width = int((high.x - low.x) * scale) + 1, height = int((high.y - low.y) * scale) + 1;
    std::vector<bool> seen(size_t(width) * height, false);
    bool twice = false;
    for (const auto& t : piece.triangles) {
      const auto at = [&](int k) {
        const Vec2d p = (piece.points[t[k]] - low) * scale;
        return Vec2f{float(p.x), float(p.y)};
      };
      const Vec2f a = at(0), b = at(1), c = at(2);
      for_each_inner_texel(a, b, c, width, height, [&](int x, int y) {
        const size_t i = size_t(y) * width + x;
        twice |= bool(seen[i]);
        seen[i] = true;
      });
    }
    return twice;
  }

  // By the plane through the middle of its longest extent, in connected parts.
  std::vector<std::vector<uint32_t>> halves(const std::vector<uint32_t>& faces) const {
    const Vec3f axis = longest_axis(faces);
    std::vector<std::pair<float, uint32_t>> order;
    for (const uint32_t f : faces) order.push_back({dot(graph_.centers[f], axis), f});
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> side[2];
    for (size_t i = 0; i < order.size(); ++i) side[i >= order.size() / 2].push_back(order[i].second);
    std::vector<std::vector<uint32_t>> out;
    for (auto& s : side) {
      std::sort(s.begin(), s.end());
      for (auto& part : connected_parts(graph_, s)) out.push_back(std::move(part));
    }
    return out;
  }

  // First eigenvector of the covariance of the faces' centers, by power iteration.
  Vec3f longest_axis(const std::vector<uint32_t>& faces) const {
    Vec3f mean{0, 0, 0}, axis{0.7f, 0.6f, 0.4f};
    for (const uint32_t f : faces) mean += graph_.centers[f] / float(faces.size());
    for (int round = 0; round < 8; ++round) {
      Vec3f next{0, 0, 0};
      for (const uint32_t f : faces) {
        const Vec3f d = graph_.centers[f] - mean;
        next += d * dot(d, axis);
      }
      if (!(length(next) > 0)) return axis;
      axis = next / length(next);
    }
    return axis;
  }

  const Mesh& mesh_;
  const FaceGraph& graph_;
  double density_;
};

std::vector<FlatChart> flat_charts(const FaceGraph& graph, const Flattener& flattener) {
  const std::vector<std::vector<uint32_t>> charts = grow_charts(graph).faces();
  std::vector<std::vector<FlatChart>> flat(charts.size());
  parallel_for(int(charts.size()), [&](int c) { flattener.flatten(charts[c], flat[c]); });
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

}  // namespace

Atlas unwrap(const Mesh& mesh, int texels) {
  if (mesh.triangles.empty()) fail("There is no surface to lay a texture on: the mesh is empty.");
  const FaceGraph graph = face_graph(mesh.positions, mesh.triangles);
  const double area = std::accumulate(graph.areas.begin(), graph.areas.end(), 0.0);
  if (!(area > 0)) fail("The surface has no triangles with an area, so it cannot have a texture.");
  const Flattener flattener(mesh, graph, double(texels) / std::sqrt(area));
  std::vector<FlatChart> charts = flat_charts(graph, flattener);
  while (true) {
    Atlas out = atlas_of(mesh, charts, texels);
    const std::vector<bool> overlapping = overlapping_charts(out, texels);
    std::vector<FlatChart> cut;  // folds thinner than flatten() sees
    for (size_t c = 0; c < charts.size(); ++c)
      if (overlapping[c] && charts[c].faces.size() > 1)
        flattener.flatten_halves(charts[c].faces, cut);
      else
        cut.push_back(std::move(charts[c]));
    if (cut.size() == charts.size()) return out;
    charts = std::move(cut);
  }
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
