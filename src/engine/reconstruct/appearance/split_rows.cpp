// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_rows.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kGrazing = 0.1f;  // minimum cosine of samples, which excludes silhouettes and bad normals

// The rest of the error of a row is about a twentieth of its reflection, and that of a hidden part of the sky
// about as large as that part. Rows whose sky is hidden altogether still tell the diffuse radiance.
float trust_of(const HiddenRings& hidden) {
  constexpr float kOtherErrors = 0.05f, kMin = 0.02f, kTypicalRoughness = 0.3f;
  static const HiddenRings energy = ring_energy(kTypicalRoughness);
  return max(1 / (1 + square(hidden_share(hidden, energy) / kOtherErrors)), kMin);
}

struct Rays {
  std::vector<Vec3f> origins, directions;
  std::vector<Surface::RayHit> hits;
  void cast(const Surface& surface) {
    hits.resize(origins.size());
    surface.intersect(origins, directions, 0, hits);
  }
};

// What hides the sky from the rows. rays: along their mirror directions; afterwards, to the middle of what
// hides the sky, where something does.
void set_hidden_sky(const Surface& surface, Rays& rays, std::vector<SplitRow>& rows) {
  rays.cast(surface);
  parallel_ranges(int(rows.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      SplitRow& row = rows[size_t(i)];
      Vec3f& direction = rays.directions[size_t(i)];
      const uint32_t vertex = nearest_corner(row.vertices, row.barycentric[1], row.barycentric[2]);
      const HiddenSky hidden =
          hidden_sky(surface, vertex, surface.mesh().normals[vertex], direction, rays.hits[size_t(i)].t >= 0);
      row.hidden = hidden.rings;
      row.trust = trust_of(row.hidden);
      row.weight = row.weight * row.trust;
      if (dot(hidden.towards, hidden.towards) > 0) direction = hidden.towards;
    }
  });
}

// Where those rays meet nothing, all of the lobe counts as lit by the sky.
void set_far_points(const Surface& surface, Rays& rays, std::vector<SplitRow>& rows) {
  rays.cast(surface);
  for (size_t i = 0; i < rows.size(); ++i) {
    const Surface::RayHit& h = rays.hits[i];
    if (h.t < 0) {
      rows[i].hidden = {};
      continue;
    }
    rows[i].far_vertices = surface.mesh().triangles[h.triangle];
    rows[i].far_barycentric = barycentrics(h.b1, h.b2);
  }
  const std::vector<Vec3f> colors = mean_colors(surface.mesh().positions.size(), rows);
  for (SplitRow& row : rows) row.far_color = at_corners(colors, row.far_vertices, row.far_barycentric);
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
  Rays rays;
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
    rays.origins.push_back(ray_origin(h));
    rays.directions.push_back(mirror_direction(h));
  }
  set_hidden_sky(surface, rays, rows);
  set_far_points(surface, rays, rows);
  return rows;
}

std::vector<Vec3f> mean_colors(size_t vertices, const std::vector<SplitRow>& rows) {
  std::vector<Vec3f> sum(vertices, Vec3f{0, 0, 0});
  std::vector<float> count(vertices, 0);
  for (const SplitRow& r : rows)
    for (int k = 0; k < 3 && !r.held_out; ++k) {
      sum[r.vertices[k]] += r.color * r.barycentric[k];
      count[r.vertices[k]] += r.barycentric[k];
    }
  for (size_t v = 0; v < vertices; ++v) sum[v] = sum[v] / max(count[v], 1e-6f);
  return sum;
}

}  // namespace cei3d
