// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/error.h"
#include "model/geometry/mesh/adjacency.h"
#include "model/geometry/mesh/cut_outline.h"
#include "model/geometry/mesh/patch.h"

namespace cei3d {
namespace {

// Rings of the mesh around a hole that take part in closing it. Albedo next to the outline is mixed with that
// of the part; the patch takes its own from kMixedRings rings away.
constexpr int kRings = 5, kMixedRings = 3;
constexpr float kBendingShare = 0.25f;  // width over which a rim is rounded, as a share of the hole's radius

using Triangle = std::array<uint32_t, 3>;

Vec3f corner_normal(std::span<const Vec3f> positions, const Triangle& t, int k) {
  const Vec3f p = positions[t[k]], u = positions[t[(k + 1) % 3]] - p, v = positions[t[(k + 2) % 3]] - p;
  const Vec3f n = cross(u, v);
  return normalize(n) * std::atan2(length(n), dot(u, v));
}

// A hole and the rings around it, as a mesh of its own.
class Hole {
 public:
  Hole(const Mesh& rest, const VertexLists& around, std::span<const Vec3f> colors,
       const std::vector<uint32_t>& loop)
      : rest_(rest), ids_(loop) {
    for (uint32_t i = 0; i < loop.size(); ++i) {
      local_.emplace(loop[i], i);
      positions_.push_back(rest.positions[loop[i]]);
    }
    fill(around);
    add_rings(around);
    colors_.resize(positions_.size(), Vec3f{0, 0, 0});
    for (size_t i = 0; i < ids_.size(); ++i)
      if (ids_[i] != kNew) colors_[i] = colors[ids_[i]];
  }

  // Adds the closed hole to the reshape of a mesh of `vertices` vertices, including those already added. rim:
  // albedo of the patch at vertices of the outline.
  void close(size_t vertices, Reshape& out, std::map<uint32_t, Vec3f>& rim) {
    std::vector<uint8_t> is_new(positions_.size());
    for (size_t i = 0; i < ids_.size(); ++i) is_new[i] = ids_[i] == kNew;
    fair(positions_, triangles_, is_new, kBendingShare * radius());
    std::vector<uint8_t> uncolored = is_new;
    const int mixed = std::min(kMixedRings, *std::max_element(ring_of_.begin(), ring_of_.end()));
    for (size_t i = 0; i < ring_of_.size(); ++i) uncolored[i] |= ring_of_[i] < mixed;
    diffuse(positions_, triangles_, uncolored, colors_);
    std::vector<Vec3f> normals(positions_.size(), Vec3f{0, 0, 0});
    for (const Triangle& t : triangles_)
      for (int k = 0; k < 3; ++k) normals[t[k]] += corner_normal(positions_, t, k);
    std::vector<uint32_t> name = ids_;
    for (size_t i = 0; i < ids_.size(); ++i) {
      if (!is_new[i]) continue;
      name[i] = uint32_t(vertices++);
      out.added_positions.push_back(positions_[i]);
      out.added_normals.push_back(normalize(normals[i]));
      out.added_colors.push_back(colors_[i]);
    }
    for (size_t i = 0; i < loop_size_; ++i) rim[ids_[i]] = colors_[i];
    for (size_t i = 0; i < patch_triangles_; ++i) {
      const auto [a, b, c] = triangles_[i];
      out.added_triangles.push_back({name[a], name[b], name[c]});
    }
  }

 private:
  static constexpr uint32_t kNew = ~0u;

  void fill(const VertexLists& around) {
    loop_size_ = ids_.size();
    std::set<std::pair<uint32_t, uint32_t>> joined;
    for (const uint32_t v : ids_)
      for (const uint32_t i : around.of(v))
        for (const uint32_t u : rest_.triangles[i])
          if (local_.count(u)) joined.emplace(local_[v], local_[u]);
    Patch patch = fill_loop(positions_, [&](uint32_t a, uint32_t b) { return joined.count({a, b}) > 0; });
    positions_ = std::move(patch.positions);
    triangles_ = std::move(patch.triangles);
    patch_triangles_ = triangles_.size();
    ids_.resize(positions_.size(), kNew);
    ring_of_.assign(ids_.size(), 0);
  }

  // Radius of the circle that is as long as the outline.
  float radius() const {
    float around = 0;
    for (size_t i = 0; i < loop_size_; ++i)
      around += length(positions_[(i + 1) % loop_size_] - positions_[i]);
    return around / (2 * kPi);
  }

  void add_rings(const VertexLists& around) {
    std::vector<uint32_t> ring(ids_.begin(), ids_.begin() + long(loop_size_)), next;
    std::set<uint32_t> used;
    for (int k = 0; k < kRings; ++k) {
      next.clear();
      for (const uint32_t v : ring)
        for (const uint32_t i : around.of(v)) {
          if (!used.insert(i).second) continue;
          Triangle t;
          for (int c = 0; c < 3; ++c) t[c] = local_id(rest_.triangles[i][c], k + 1, next);
          triangles_.push_back(t);
        }
      ring.swap(next);
    }
  }

  uint32_t local_id(uint32_t v, int ring, std::vector<uint32_t>& fresh) {
    const auto [at, is_fresh] = local_.try_emplace(v, uint32_t(positions_.size()));
    if (is_fresh) {
      positions_.push_back(rest_.positions[v]);
      ids_.push_back(v);
      ring_of_.push_back(ring);
      fresh.push_back(v);
    }
    return at->second;
  }

  const Mesh& rest_;
  std::vector<uint32_t> ids_;  // in the whole mesh; kNew: of the patch
  std::vector<int> ring_of_;   // 0: the patch and its outline
  std::map<uint32_t, uint32_t> local_;
  std::vector<Vec3f> positions_, colors_;
  std::vector<Triangle> triangles_;  // the patch's first
  size_t loop_size_ = 0, patch_triangles_ = 0;
};

size_t count_pieces(const Mesh& mesh) {
  const VertexLists neighbors = neighbors_of(mesh.positions.size(), mesh.triangles);
  std::vector<uint8_t> seen(mesh.positions.size(), 0);
  std::vector<uint32_t> queue;
  size_t pieces = 0;
  for (uint32_t start = 0; start < seen.size(); ++start) {
    if (seen[start] || neighbors.of(start).empty()) continue;
    ++pieces;
    for (queue.assign(1, start), seen[start] = 1; !queue.empty();) {
      const uint32_t v = queue.back();
      queue.pop_back();
      for (const uint32_t u : neighbors.of(v))
        if (!seen[u]) seen[u] = 1, queue.push_back(u);
    }
  }
  return pieces;
}

}  // namespace

CutResult cut(const Mesh& mesh, std::span<const uint8_t> in_part, std::span<const Vec3f> colors) {
  const Outline outline = outline_of(mesh, clean_labels(mesh, in_part));
  CutResult result;
  Mesh rest{mesh.positions, mesh.normals, {}, {}};
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (outline.removed[i])
      result.reshape.removed.push_back(i);
    else
      rest.triangles.push_back(mesh.triangles[i]);
  if (result.reshape.removed.empty())
    fail("The part holds nothing of the surface, so there is nothing to remove. Choose another part.");
  if (rest.triangles.empty())
    fail("The part is the whole surface, so nothing would be left. Choose a smaller part.");
  const VertexLists around = triangles_around(rest.positions.size(), rest.triangles);
  Reshape& reshape = result.reshape;
  std::map<uint32_t, Vec3f> rim;
  for (const std::vector<uint32_t>& loop : outline.loops)
    Hole(rest, around, colors, loop)
        .close(mesh.positions.size() + reshape.added_positions.size(), reshape, rim);
  for (const auto& [vertex, color] : rim) {
    reshape.rim.push_back(vertex);
    reshape.rim_colors.push_back(color);
  }
  result.report = {outline.loops.size(), count_pieces(rest)};
  return result;
}

}  // namespace cei3d
