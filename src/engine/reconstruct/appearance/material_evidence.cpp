// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/material_evidence.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/ladder.h"
#include "core/math/parabola.h"
#include "engine/reconstruct/appearance/split_irradiance.h"

namespace cei3d {
namespace {

constexpr int kLevels = BlurLadder::kLevels;
constexpr int kGrain = 1024;  // vertices per chunk
// Bounds of the reflectance of a metal while the scale of the light is uncertain.
constexpr float kMinMetal = 0.02f, kMaxMetal = 4;

uint32_t nearest_vertex(const SplitRow& r) {
  return nearest_corner(r.vertices, r.barycentric[1], r.barycentric[2]);
}

// Least squares of one coefficient per channel: y = k s.
struct OneCoefficient {
  Vec3f ss{0, 0, 0}, sy{0, 0, 0}, yy{0, 0, 0};
  void add(Vec3f weight, Vec3f s, Vec3f y) {
    ss += weight * s * s;
    sy += weight * s * y;
    yy += weight * y * y;
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

// Minimum of the errors over the levels, by a parabola through the smallest and its neighbors.
void minimum(const float* e, float& roughness, float& error) {
  const int best = int(std::min_element(e, e + kLevels) - e);
  float at = float(best);
  error = e[best];
  if (best > 0 && best < kLevels - 1) at += float(lowest_offset(e[best - 1], e[best], e[best + 1]));
  const int level = std::min(int(at), kLevels - 2);
  const GeometricLadder step{BlurLadder::roughness(level), BlurLadder::roughness(level + 1)};
  roughness = step.at(at - float(level));
}

}  // namespace

LitSamples::LitSamples(size_t vertices, const std::vector<SplitRow>& rows, std::vector<Vec3f> colors,
                       BlurLadder& blurs, const std::vector<Vec3f>& light)
    : rows_(rows), colors_(std::move(colors)), light_height_(blurs.height()), start_(vertices + 1, 0) {
  light_directions_ = light_directions(sky_radiance(light_image(light, light_height_)));
  for (int level = 0; level < kLevels; ++level) sky_.set(level, light, blurs);
  for (const SplitRow& r : rows)
    if (!r.held_out) ++start_[nearest_vertex(r) + 1];
  for (size_t v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
  order_.resize(start_.back());
  std::vector<uint32_t> at(start_.begin(), start_.end() - 1);
  for (uint32_t i = 0; i < rows.size(); ++i)
    if (!rows[i].held_out) order_[at[nearest_vertex(rows[i])]++] = i;
}

LitSamples::RowLight LitSamples::light_of(const SplitRow& row, float roughness) const {
  const SplitSum<float> s = split_sum(split_sum_table(), row.nv, roughness);
  const auto incident = [&](ReflectionPart part) {
    return incident_at(sky_, reflected_sky(row, part, roughness, light_height_), row);
  };
  return {reflected_parts(s, incident(ReflectionPart::base), incident(ReflectionPart::fresnel)),
          row.diffuse_light * diffuse_view_of(row, roughness, light_directions_)};
}

// Calls visit(row, its color, RowLight) for the vertex' samples. Returns their number.
template <class F>
int LitSamples::for_samples(uint32_t vertex, float roughness, const F& visit) const {
  for (uint32_t k = start_[vertex]; k < start_[vertex + 1]; ++k) {
    const SplitRow& row = rows_[order_[k]];
    visit(row, colors_[order_[k]], light_of(row, roughness));
  }
  return int(start_[vertex + 1] - start_[vertex]);
}

// Adds the errors of the dielectric and the metal of that level. Returns the number of samples.
int LitSamples::add_errors(uint32_t vertex, int level, Vec3f max_diffuse, float* errors) const {
  const Vec3f black{0, 0, 0}, white{1, 1, 1}, f0 = f0_of(black, kUsualSpecular, 0.0f);
  OneCoefficient dielectric, metal;
  const int count = for_samples(vertex, BlurLadder::roughness(level),
                                [&](const SplitRow& row, Vec3f color, const RowLight& s) {
                                  dielectric.add(row.weight, s.diffuse, s.reflected.removed_from(color, f0));
                                  metal.add(row.weight, s.reflected.base, color - s.reflected.fresnel);
                                });
  errors[level] = dielectric.error(black, max_diffuse);
  errors[kLevels + level] = metal.error(white * kMinMetal, white * kMaxMetal);
  return count;
}

MaterialEvidence LitSamples::evidence(const std::vector<Vec3f>& max_diffuse) const {
  const size_t n = start_.size() - 1;
  MaterialEvidence out;
  out.error.assign(n * MaterialEvidence::kHypotheses, 0.0f);
  out.samples.assign(n, 0.0f);
  parallel_ranges(int(n), kGrain, [&](int begin, int end) {
    for (int level = 0; level < kLevels; ++level)
      for (int v = begin; v < end; ++v)
        out.samples[v] = float(add_errors(uint32_t(v), level, max_diffuse[v],
                                          &out.error[size_t(v) * MaterialEvidence::kHypotheses]));
  });
  return out;
}

namespace {

// Divides the unit sphere into cubes, whose errors are independent.
constexpr int kPlacesAcross = 5, kPlaces = kPlacesAcross * kPlacesAcross * kPlacesAcross;

size_t place_of(Vec3f p) {
  const auto cell = [](float x) {
    return std::clamp(int((x + 1) / 2 * kPlacesAcross), 0, kPlacesAcross - 1);
  };
  return size_t((cell(p.x) * kPlacesAcross + cell(p.y)) * kPlacesAcross + cell(p.z));
}

}  // namespace

std::vector<ReflectionSample> LitSamples::of_dielectric(uint32_t vertex, const Material& m) const {
  const Vec3f f0 = f0_of(Vec3f{0, 0, 0}, kUsualSpecular, 0.0f);
  std::vector<ReflectionSample> out;
  for_samples(vertex, m.roughness, [&](const SplitRow& row, Vec3f color, const RowLight& s) {
    out.push_back({row.weight, s.diffuse, s.reflected.sum(f0), color});
  });
  return out;
}

std::vector<Vec3f> LitSamples::fit_diffuse(const SplitMaterials& materials, std::vector<Vec3f> before) const {
  parallel_ranges(int(before.size()), kGrain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      if (materials.is_metal(uint32_t(v))) continue;
      const std::vector<ReflectionSample> samples = of_dielectric(uint32_t(v), materials.of[size_t(v)]);
      if (!samples.empty()) before[size_t(v)] = diffuse_of(samples);
    }
  });
  return before;
}

template <class F>
void LitSamples::for_dielectrics(const SplitMaterials& materials, const F& visit) const {
  for (uint32_t v = 0; v + 1 < start_.size(); ++v)
    if (!materials.is_metal(v) && start_[v + 1] > start_[v]) visit(v, of_dielectric(v, materials.of[v]));
}

LightScale LitSamples::light_scale(const SplitMaterials& materials, const std::vector<Vec3f>& positions,
                                   const SampleNoise& noise) const {
  std::vector<ScaleEquations> places(kPlaces);
  for_dielectrics(materials, [&](uint32_t v, const std::vector<ReflectionSample>& samples) {
    places[place_of(positions[v])].add(samples, noise);
  });
  return cei3d::light_scale(places);
}

NoiseSums LitSamples::noise(const SplitMaterials& materials) const {
  NoiseSums sums;
  for_dielectrics(materials,
                  [&](uint32_t, const std::vector<ReflectionSample>& samples) { sums.add(samples); });
  return sums;
}

LightScale LitSamples::light_scale(const SplitMaterials& materials,
                                   const std::vector<Vec3f>& positions) const {
  return light_scale(materials, positions, noise(materials).noise());
}

LightScale LitSamples::light_correction(const SplitMaterials& materials,
                                        const std::vector<Vec3f>& positions) const {
  const NoiseSums sums = noise(materials);
  SampleNoise plain = sums.noise();
  LightScale scale = light_scale(materials, positions, plain);
  plain.diffuse = 0;
  scale.factor = scale.factor / light_scale(materials, positions, plain).factor;
  scale.reflected = sums.reflected();
  return scale;
}

BestMaterials best_materials(const float* errors) {
  BestMaterials b{};
  minimum(errors, b.dielectric_roughness, b.dielectric_error);
  minimum(errors + kLevels, b.metal_roughness, b.metal_error);
  return b;
}

SimilarNeighbors::SimilarNeighbors(const Mesh& mesh, const std::vector<Vec3f>& colors)
    : lists(joined_by(mesh.positions.size(), edges_of(mesh.triangles))) {
  constexpr float kContrast = 0.05f;  // of display-encoded colors: a border between materials
  for (uint32_t v = 0; v < mesh.positions.size(); ++v)
    for (const uint32_t other : lists.of(v)) {
      const Vec3f d = srgb_from_linear(colors[v]) - srgb_from_linear(colors[other]);
      weight.push_back(std::exp(-dot(d, d) / (2 * kContrast * kContrast)));
    }
}

namespace {

// The mean of the vertex and its neighbors.
void mean_around(const SimilarNeighbors& near, const MaterialEvidence& e, uint32_t v, MaterialEvidence& out) {
  constexpr int kH = MaterialEvidence::kHypotheses;
  float total = 1, sum[kH], samples = e.samples[v];
  std::copy(e.of(v), e.of(v) + kH, sum);
  for (uint32_t k = near.lists.start[v]; k < near.lists.start[v + 1]; ++k) {
    const uint32_t neighbor = near.lists.items[k];
    const float* other = e.of(neighbor);
    for (int h = 0; h < kH; ++h) sum[h] += near.weight[k] * other[h];
    samples += near.weight[k] * e.samples[neighbor];
    total += near.weight[k];
  }
  for (int h = 0; h < kH; ++h) out.error[size_t(v) * kH + h] = sum[h] / total;
  out.samples[v] = samples / total;
}

}  // namespace

void diffuse_evidence(const SimilarNeighbors& near, int steps, MaterialEvidence& e) {
  MaterialEvidence next = e;
  for (int step = 0; step < steps; ++step) {
    parallel_ranges(int(e.samples.size()), kGrain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) mean_around(near, e, uint32_t(v), next);
    });
    std::swap(e, next);
  }
}

namespace {

constexpr float kOwn = 0.03f;  // weight of what a vertex itself says, where each neighbor has at most 1

// By its own samples. The ratio of errors to the power of kSlope: samples of a vertex share their faults.
float own_probability(const MaterialEvidence& e, uint32_t v, float even) {
  constexpr float kSlope = 1.5f;
  const BestMaterials b = best_materials(e.of(v));
  const float metal = std::pow(b.metal_error, kSlope),
              dielectric = std::pow(even * b.dielectric_error, kSlope);
  return metal + dielectric > 0 ? dielectric / (metal + dielectric) : 0;
}

// Mean of `own`, unless the vertex has no samples, and of the present probabilities of its neighbors.
float next_probability(const SimilarNeighbors& near, uint32_t v, float samples, float own,
                       const std::vector<float>& present) {
  const float weight = samples > 0 ? kOwn : 0;
  float sum = weight * own, total = weight;
  for (uint32_t k = near.lists.start[v]; k < near.lists.start[v + 1]; ++k) {
    sum += near.weight[k] * present[near.lists.items[k]];
    total += near.weight[k];
  }
  return total > 0 ? sum / total : own;
}

}  // namespace

// By Jacobi's method, which is stopped before its end. Among six neighbors of the same color a walk has 200
// steps in the mean, which reach 14 vertices far.
std::vector<float> metal_probability(const SimilarNeighbors& near, const MaterialEvidence& e, float even,
                                     int steps) {
  const auto n = uint32_t(e.samples.size());
  std::vector<float> own(n, 0.0f);
  for (uint32_t v = 0; v < n; ++v)
    if (e.samples[v] > 0) own[v] = own_probability(e, v, even);
  std::vector<float> present = own, next = own;
  for (int step = 0; step < steps; ++step) {
    parallel_ranges(int(n), kGrain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v)
        next[size_t(v)] = next_probability(near, uint32_t(v), e.samples[size_t(v)], own[size_t(v)], present);
    });
    std::swap(present, next);
  }
  return present;
}

}  // namespace cei3d
