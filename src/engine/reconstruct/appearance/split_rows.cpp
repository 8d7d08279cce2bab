// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_rows.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr float kGrazing = 0.1f;  // minimum cosine of samples, which excludes silhouettes and bad normals
constexpr float kPatch = 0.05f;   // size of a patch, unit frame

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
void set_far_points(const Surface& surface, Rays& rays, const std::vector<Vec3f>& colors,
                    std::vector<SplitRow>& rows) {
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
  for (SplitRow& row : rows) row.far_color = at_corners(colors, row.far_vertices, row.far_barycentric);
}

bool is_steep(const Hit& h) { return dot(h.normal, h.to_camera) > kGrazing; }

bool is_held_out(const SurfaceSamples& samples, size_t i, const LinearSplitOptions& options) {
  return options.hold_out > 0 && samples.turned.views[i] % options.hold_out == 0;
}

uint64_t patch_of(Vec3f p) {
  uint64_t key = 0;
  for (int c = 0; c < 3; ++c) key = key << 16 | uint64_t(int(std::floor((p[c] + 1) / kPatch)) + 0x4000);
  return key;
}

// In the order of their vertices, so that rows near each other read and write memory near each other.
std::vector<uint32_t> choose_samples(const Mesh& mesh, const SurfaceSamples& s, const LinearSplitOptions& o) {
  std::vector<uint32_t> kept;
  const double share = double(o.max_hits) / std::max<double>(1, double(s.hits.size()));
  for (uint32_t i = 0; i < s.hits.size(); ++i) {
    const uint64_t chosen_by = o.in_patches ? patch_of(s.hits[i].position) : i;
    if (is_steep(s.hits[i]) && Rng(o.seed, 0, chosen_by).uniform() < share) kept.push_back(i);
  }
  const auto vertex = [&](uint32_t i) { return mesh.triangles[s.hits[i].triangle][0]; };
  std::stable_sort(kept.begin(), kept.end(), [&](uint32_t a, uint32_t b) { return vertex(a) < vertex(b); });
  return kept;
}

}  // namespace

std::vector<SplitRow> make_split_rows(const Surface& surface, const SurfaceSamples& samples,
                                      const LinearSplitOptions& options, const std::vector<Vec3f>& colors) {
  const Mesh& mesh = surface.mesh();
  const std::vector<uint32_t> kept = choose_samples(mesh, samples, options);
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
    row.held_out = is_held_out(samples, kept[k], options);
    row.nv = dot(h.normal, h.to_camera);
    row.color = samples.colors[kept[k]];
    for (int c = 0; c < 3; ++c) row.weight[c] = square(srgb_derivative(row.color[c]));
    row.clipped = samples.clipped.empty() ? 0 : samples.clipped[kept[k]];
    rays.origins.push_back(ray_origin(h));
    rays.directions.push_back(mirror_direction(h));
  }
  set_hidden_sky(surface, rays, rows);
  set_far_points(surface, rays, colors, rows);
  return rows;
}

std::vector<Vec3f> mean_colors(const Mesh& mesh, const SurfaceSamples& samples,
                               const LinearSplitOptions& options) {
  std::vector<Vec3f> sum(mesh.positions.size(), Vec3f{0, 0, 0});
  std::vector<float> count(sum.size(), 0);
  for (size_t i = 0; i < samples.hits.size(); ++i) {
    const Hit& h = samples.hits[i];
    if (!is_steep(h) || is_held_out(samples, i, options)) continue;
    const auto b = barycentrics(h.b1, h.b2);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[h.triangle][k];
      sum[v] += samples.colors[i] * b[k];
      count[v] += b[k];
    }
  }
  for (size_t v = 0; v < sum.size(); ++v) sum[v] = sum[v] / max(count[v], 1e-6f);
  return sum;
}

}  // namespace cei3d
