// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_rows.h"

#include <algorithm>

#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kGrazing = 0.1f;  // minimum cosine of samples, which excludes silhouettes and bad normals

void set_far_hit(const Mesh& mesh, const Surface::RayHit& h, SplitRow& row) {
  const auto& t = mesh.triangles[h.triangle];
  row.blocked = true;
  row.far_vertices = {t[0], t[1], t[2]};
  row.far_barycentric = barycentrics(h.b1, h.b2);
}

std::vector<uint32_t> choose_samples(const SurfaceSamples& s, const LinearSplitOptions& o) {
  std::vector<uint32_t> kept;
  const double share = double(o.max_hits) / std::max<double>(1, double(s.hits.size()));
  for (uint32_t i = 0; i < s.hits.size(); ++i)
    if (dot(s.hits[i].normal, s.hits[i].to_camera) > kGrazing && Rng(o.seed, 0, i).uniform() < share)
      kept.push_back(i);
  return kept;
}

}  // namespace

std::vector<SplitRow> make_split_rows(const Surface& surface, const SurfaceSamples& samples,
                                      const LinearSplitOptions& options) {
  const Mesh& mesh = surface.mesh();
  const std::vector<uint32_t> kept = choose_samples(samples, options);
  const size_t n = kept.size();
  std::vector<SplitRow> rows(n);
  std::vector<Vec3f> origins(n), directions(n);
  for (size_t k = 0; k < n; ++k) {
    const Hit& h = samples.hits[kept[k]];
    SplitRow& row = rows[k];
    const auto& t = mesh.triangles[h.triangle];
    row = {};
    row.vertices = {t[0], t[1], t[2]};
    row.barycentric = barycentrics(h.b1, h.b2);
    row.normal = samples.turned.in_room(kept[k], h.normal);
    row.to_camera = samples.turned.in_room(kept[k], h.to_camera);
    row.view = samples.turned.views.empty() ? 0 : samples.turned.views[kept[k]];
    row.held_out = options.hold_out > 0 && samples.turned.views[kept[k]] % options.hold_out == 0;
    row.nv = dot(h.normal, h.to_camera);
    row.color = samples.colors[kept[k]];
    for (int c = 0; c < 3; ++c) row.weight[c] = square(srgb_derivative(row.color[c]));
    row.clipped = samples.clipped.empty() ? 0 : samples.clipped[kept[k]];
    origins[k] = ray_origin(h);
    directions[k] = mirror_direction(h);
  }
  std::vector<Surface::RayHit> hits(n);
  surface.intersect(origins, directions, 0, hits);
  for (size_t k = 0; k < n; ++k)
    if (hits[k].t >= 0) set_far_hit(mesh, hits[k], rows[k]);
  return rows;
}

}  // namespace cei3d
