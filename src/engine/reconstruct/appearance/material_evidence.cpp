// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/material_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr int kLevels = BlurLadder::kLevels;
constexpr float kMinMetal = 0.02f,
                kMaxMetal = 4;  // reflectance of a metal, the light's scale being uncertain

uint32_t nearest_vertex(const SplitRow& r) {
  const auto& b = r.barycentric;
  return b[0] >= b[1] && b[0] >= b[2] ? r.vertices[0] : b[1] >= b[2] ? r.vertices[1] : r.vertices[2];
}

// Rows by the vertex nearest to them.
struct RowsOfVertices {
  std::vector<uint32_t> start, rows;  // #V + 1; #rows

  RowsOfVertices(size_t vertices, const std::vector<SplitRow>& all) : start(vertices + 1, 0) {
    for (const SplitRow& r : all) ++start[nearest_vertex(r) + 1];
    for (size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
    rows.resize(all.size());
    std::vector<uint32_t> at(start.begin(), start.end() - 1);
    for (uint32_t i = 0; i < all.size(); ++i) rows[at[nearest_vertex(all[i])]++] = i;
  }
};

// Least squares of one coefficient: y = k s.
struct OneCoefficient {
  Vec3f ss{0, 0, 0}, sy{0, 0, 0}, yy{0, 0, 0};
  void add(Vec3f w, Vec3f s, Vec3f y) {
    ss += w * s * s;
    sy += w * s * y;
    yy += w * y * y;
  }
  // Squared error of the best coefficient within bounds.
  float error(Vec3f low, Vec3f high) const {
    float sum = 0;
    for (int c = 0; c < 3; ++c) {
      const float k = clamp(ss[c] > 0 ? sy[c] / ss[c] : 0.0f, low[c], high[c]);
      sum += max(yy[c] - 2 * k * sy[c] + k * k * ss[c], 0.0f);
    }
    return sum;
  }
};

Blurred all_levels(BlurLadder& blurs, const std::vector<Vec3f>& light) {
  Blurred out;
  for (int level = 0; level < kLevels; ++level) blurs.level(level).apply(light, out[size_t(level)]);
  return out;
}

}  // namespace

MaterialEvidence material_evidence(const Mesh& mesh, const std::vector<SplitRow>& rows,
                                   std::span<const Vec3f> colors, BlurLadder& blurs,
                                   const std::vector<Vec3f>& light, const std::vector<Vec3f>& max_diffuse) {
  const size_t n = mesh.positions.size();
  const RowsOfVertices of(n, rows);
  MaterialEvidence out;
  out.error.assign(n * MaterialEvidence::kHypotheses, 0.0f);
  out.samples.assign(n, 0.0f);
  const float* table = split_sum_table();
  const Vec3f black{0, 0, 0}, low{kMinMetal, kMinMetal, kMinMetal}, high{kMaxMetal, kMaxMetal, kMaxMetal};
  const Blurred sky = all_levels(blurs, light);
  for (int level = 0; level < kLevels; ++level) {
    const float roughness = BlurLadder::roughness(level);
    parallel_ranges(int(n), 1024, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        OneCoefficient dielectric, metal;
        int count = 0;
        for (uint32_t k = of.start[v]; k < of.start[v + 1]; ++k) {
          const SplitRow& row = rows[of.rows[k]];
          if (row.blocked) continue;
          const SplitSum<float> s = split_sum(table, row.nv, roughness);
          const Vec3f w = row.weight;
          const Vec3f base =
              radiance_at(sky, reflected_sky(row, ReflectionPart::base, roughness, blurs.height())) * s.scale;
          const Vec3f rest = colors[of.rows[k]] - radiance_at(sky, reflected_sky(row, ReflectionPart::fresnel,
                                                                                 roughness, blurs.height())) *
                                                      s.bias;
          const float d = diffuse_view(clamp(row.nv, 0.0f, 1.0f), roughness);
          dielectric.add(w, {d, d, d}, rest - base * f0_of(black, 0.5f, 0.0f));
          metal.add(w, base, rest);
          ++count;
        }
        if (count == 0) continue;
        float* e = &out.error[size_t(v) * MaterialEvidence::kHypotheses];
        e[level] = dielectric.error(black, max_diffuse[v]);
        e[kLevels + level] = metal.error(low, high);
        out.samples[v] = float(count);
      }
    });
  }
  return out;
}

void diffuse_evidence(const Mesh& mesh, const std::vector<Vec3f>& colors, int rounds, MaterialEvidence& e) {
  constexpr float kContrast = 0.05f;  // of display-encoded colors: a border between materials
  constexpr int kH = MaterialEvidence::kHypotheses;
  const size_t n = mesh.positions.size();
  std::vector<std::array<uint32_t, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      if (t[c] < t[(c + 1) % 3]) edges.push_back({t[c], t[(c + 1) % 3]});
  std::vector<uint32_t> start(n + 1, 0);
  for (const auto& edge : edges) ++start[edge[0] + 1], ++start[edge[1] + 1];
  for (size_t v = 0; v < n; ++v) start[v + 1] += start[v];
  std::vector<uint32_t> neighbor(start.back());
  std::vector<float> weight(start.back());
  std::vector<uint32_t> at(start.begin(), start.end() - 1);
  for (const auto& edge : edges) {
    const Vec3f d = colors[edge[0]] - colors[edge[1]];
    const float w = std::exp(-dot(d, d) / (2 * kContrast * kContrast));
    for (int side = 0; side < 2; ++side) {
      neighbor[at[edge[side]]] = edge[1 - side];
      weight[at[edge[side]]++] = w;
    }
  }
  std::vector<float> error(e.error.size()), samples(n);
  for (int round = 0; round < rounds; ++round) {
    parallel_ranges(int(n), 1024, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        float total = 1, sum[kH], count = e.samples[v];
        std::copy(e.of(v), e.of(v) + kH, sum);
        for (uint32_t k = start[v]; k < start[v + 1]; ++k) {
          const float w = weight[k];
          const float* other = e.of(neighbor[k]);
          for (int h = 0; h < kH; ++h) sum[h] += w * other[h];
          count += w * e.samples[neighbor[k]];
          total += w;
        }
        for (int h = 0; h < kH; ++h) error[size_t(v) * kH + h] = sum[h] / total;
        samples[v] = count / total;
      }
    });
    e.error.swap(error);
    e.samples.swap(samples);
  }
  for (size_t v = 0; v < n; ++v)
    for (int h = 0; h < kH; ++h) e.error[v * kH + h] /= max(3 * e.samples[v], 1e-6f);
}

namespace {

// Minimum of errors over the levels, by a parabola through the least and its neighbors.
void minimum(const float* e, float& roughness, float& error) {
  const int best = int(std::min_element(e, e + kLevels) - e);
  float at = float(best);
  error = e[best];
  if (best > 0 && best < kLevels - 1) {
    const float a = e[best - 1], b = e[best], c = e[best + 1], bend = a - 2 * b + c;
    if (bend > 0) at += clamp(0.5f * (a - c) / bend, -0.5f, 0.5f);
  }
  const int level = std::min(int(at), kLevels - 2);
  const float low = BlurLadder::roughness(level), high = BlurLadder::roughness(level + 1);
  roughness = low * std::pow(high / low, at - float(level));
}

}  // namespace

BestMaterials best_materials(const float* errors) {
  BestMaterials b{};
  minimum(errors, b.dielectric_roughness, b.dielectric_error);
  minimum(errors + kLevels, b.metal_roughness, b.metal_error);
  return b;
}

std::vector<Vec3f> mean_colors(const Mesh& mesh, const std::vector<SplitRow>& rows) {
  std::vector<Vec3f> sum(mesh.positions.size(), Vec3f{0, 0, 0});
  std::vector<float> count(sum.size(), 0);
  for (const SplitRow& r : rows)
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) sum[r.vertices[k]][c] += r.barycentric[k] * srgb_from_linear(r.color[c]);
      count[r.vertices[k]] += r.barycentric[k];
    }
  for (size_t v = 0; v < sum.size(); ++v) sum[v] = sum[v] / max(count[v], 1e-6f);
  return sum;
}

LightScale light_scale(const Mesh& mesh, const std::vector<SplitRow>& rows, std::span<const Vec3f> colors,
                       BlurLadder& blurs, const std::vector<Vec3f>& light, const SplitMaterials& materials) {
  const size_t n = mesh.positions.size();
  const RowsOfVertices of(n, rows);
  const Blurred sky = all_levels(blurs, light);
  const float* table = split_sum_table();
  double above[3] = {0, 0, 0}, below[3] = {0, 0, 0};
  for (size_t v = 0; v < n; ++v) {
    if (materials.is_metal(uint32_t(v))) continue;
    const float roughness = materials.of[v].roughness;
    Vec3f dd{0, 0, 0}, dg{0, 0, 0}, gg{0, 0, 0}, dc{0, 0, 0}, gc{0, 0, 0};
    for (uint32_t k = of.start[v]; k < of.start[v + 1]; ++k) {
      const SplitRow& row = rows[of.rows[k]];
      if (row.blocked) continue;
      const SplitSum<float> s = split_sum(table, row.nv, roughness);
      const Vec3f w = row.weight;
      const Vec3f g =
          radiance_at(sky, reflected_sky(row, ReflectionPart::base, roughness, blurs.height())) *
              f0_of({0, 0, 0}, 0.5f, 0.0f) * s.scale +
          radiance_at(sky, reflected_sky(row, ReflectionPart::fresnel, roughness, blurs.height())) * s.bias;
      const float d = diffuse_view(clamp(row.nv, 0.0f, 1.0f), roughness);
      dd += w * (d * d), dg += w * g * d, gg += w * g * g, dc += w * colors[of.rows[k]] * d,
          gc += w * g * colors[of.rows[k]];
    }
    for (int c = 0; c < 3; ++c) {
      if (dd[c] <= 0) continue;
      const bool black = dc[c] < dg[c];  // what is diffuse would be negative
      above[c] += double(gc[c]) - (black ? 0 : double(dg[c]) * dc[c] / dd[c]);
      below[c] += double(gg[c]) - (black ? 0 : double(dg[c]) * dg[c] / dd[c]);
    }
  }
  LightScale s;
  for (int c = 0; c < 3; ++c) {
    s.factor[c] = below[c] > 0 ? float(above[c] / below[c]) : 1.0f;
    s.curvature[c] = float(below[c]);
  }
  return s;
}

}  // namespace cei3d
