// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/flatten.h"

#include <algorithm>
#include <numeric>

#include "model/geometry/unwrap/charts.h"
#include "model/geometry/unwrap/raster.h"

namespace cei3d {
namespace {

uint32_t root(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void Flattener::flatten(std::vector<uint32_t> faces, double max_stretch, std::vector<FlatChart>& out) const {
  std::vector<std::vector<uint32_t>> open{std::move(faces)};
  while (!open.empty()) {
    std::vector<uint32_t> part = std::move(open.back());
    open.pop_back();
    if (auto chart = flat_in_one(part, max_stretch))
      out.push_back(std::move(*chart));
    else
      for (auto& half : halves(part)) open.push_back(std::move(half));
  }
}

void Flattener::flatten_halves(const std::vector<uint32_t>& faces, double max_stretch,
                               std::vector<FlatChart>& out) const {
  for (auto& half : halves(faces)) flatten(std::move(half), max_stretch, out);
}

std::optional<FlatChart> Flattener::flat_in_one(std::vector<uint32_t> faces, double max_stretch) const {
  FlatChart out;
  const Patch2d patch = patch_of(faces, out.vertex);
  out.faces = std::move(faces);
  out.flat.triangles = patch.triangles;
  for (const bool conformal : {true, false}) {
    out.flat.points = conformal ? conformal_map(patch) : projection(patch);
    const Stretch s = stretch_of(patch, out.flat.points);
    out.stretch = s.l2;
    if (!s.flipped && s.l2 <= max_stretch && !overlaps_itself(out.flat)) return out;
  }
  return patch.triangles.size() == 1 ? std::optional(std::move(out)) : std::nullopt;
}

// Joins corners across the edges inside of the piece.
Patch2d Flattener::patch_of(std::span<const uint32_t> faces, std::vector<uint32_t>& vertex) const {
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

void Flattener::join_across(std::span<const uint32_t> faces, uint32_t i, uint32_t k,
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

// At twice the density that the texture will have.
bool Flattener::overlaps_itself(const FlatPiece& piece) const {
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
std::vector<std::vector<uint32_t>> Flattener::halves(const std::vector<uint32_t>& faces) const {
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
Vec3f Flattener::longest_axis(const std::vector<uint32_t>& faces) const {
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

}  // namespace cei3d
