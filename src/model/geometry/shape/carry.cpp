// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/carry.h"

#include "core/base/parallel.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {
namespace {

// Nearest vertex, for points near the mesh.
class NearestVertex {
 public:
  explicit NearestVertex(const Mesh& mesh)
      : mesh_(mesh), radius_(typical_edge(mesh) * 3), index_(mesh.positions, radius_) {}

  // -1: none is within three edges' length.
  int operator()(Vec3f x) const {
    int best = -1;
    float smallest = radius_ * radius_;
    index_.any_within(x, radius_, [&](size_t v) {
      const Vec3f d = mesh_.positions[v] - x;
      if (dot(d, d) < smallest || best < 0) smallest = dot(d, d), best = int(v);
      return false;
    });
    return best;
  }

 private:
  static float typical_edge(const Mesh& mesh) {
    double sum = 0;
    for (const std::array<uint32_t, 3>& t : mesh.triangles)
      sum += length(mesh.positions[t[1]] - mesh.positions[t[0]]);
    return float(sum / double(std::max<size_t>(mesh.triangles.size(), 1))) + 1e-6f;
  }
  const Mesh& mesh_;
  float radius_;
  PointIndex index_;
};

// For each vertex of the mesh before: its index in change.moved, or one of these.
constexpr int kStays = -1, kGone = -2;
std::vector<int> fates(const Mesh& before, const Mesh& after, const Reshape& change) {
  std::vector<uint8_t> used(after.positions.size(), 0), was_used(after.positions.size(), 0);
  for (const std::array<uint32_t, 3>& t : after.triangles)
    for (const uint32_t v : t) used[v] = 1;
  for (const std::array<uint32_t, 3>& t : before.triangles)
    for (const uint32_t v : t) was_used[v] = 1;
  std::vector<int> fate(before.positions.size(), kStays);
  for (size_t i = 0; i < change.moved.size(); ++i) fate[change.moved[i]] = int(i);
  for (size_t v = 0; v < fate.size(); ++v)
    if (was_used[v] && !used[v]) fate[v] = kGone;
  return fate;
}

HandlerPoints on_new_matter(const Reshape& change, float spacing) {
  std::vector<Hit> hits;
  for (size_t i = 0; i < change.added_positions.size(); ++i)
    hits.push_back({change.added_positions[i], change.added_normals[i], change.added_normals[i], 0, 0, 0});
  return thin_hits(hits, std::vector<float>(hits.size(), spacing), spacing);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

HandlerPoints carried(const HandlerPoints& points, const Mesh& before, const Mesh& after,
                      const Reshape& change) {
  const NearestVertex nearest(before);
  const std::vector<int> fate = fates(before, after, change);
  std::vector<int> vertex(points.positions.size());
  parallel_ranges(int(vertex.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) vertex[i] = nearest(points.positions[i]);
  });
  HandlerPoints out;
  out.spacing = points.spacing;
  for (size_t i = 0; i < vertex.size(); ++i) {
    const int v = vertex[i], f = v < 0 ? kStays : fate[v];
    if (f == kGone) continue;
    Vec3f p = points.positions[i], n = points.normals[i];
    if (f >= 0) {
      const Mat3f gradient = change.gradient(f);
      p = change.positions[f] + gradient * (p - before.positions[v]);
      n = normalize(inverse_transpose(gradient) * n);
    }
    out.positions.push_back(p);
    out.normals.push_back(n);
    out.footprints.push_back(points.footprints[i]);
  }
  const HandlerPoints fresh = on_new_matter(change, points.spacing);
  append(out.positions, fresh.positions);
  append(out.normals, fresh.normals);
  append(out.footprints, fresh.footprints);
  return out;
}

}  // namespace cei3d
