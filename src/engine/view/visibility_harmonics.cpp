// SPDX-License-Identifier: Apache-2.0
#include "engine/view/visibility_harmonics.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/harmonics.h"
#include "engine/view/quantize.h"

namespace cei3d {
namespace {

// The basis times the harmonics, which are multiples of it, and of all sky directions the solid angle of one:
// visible directions are summed with these weights.
std::vector<VisibilityTerms> weights_of_directions() {
  std::vector<VisibilityTerms> out;
  for (const Vec3f d : sky_directions()) {
    const Harmonics h = harmonics(d);
    const VisibilityTerms basis = visibility_basis(d);
    VisibilityTerms w;
    for (size_t k = 0; k < kVisibilityTerms; ++k) {
      const float constant = std::abs(basis[k]) > 1e-6f ? h[k] / basis[k] : 0;
      w[k] = h[k] * constant * (4 * kPi / kSkyDirections);
    }
    out.push_back(w);
  }
  return out;
}

VisibilityTerms terms_of(const Surface& surface, uint32_t vertex,
                         const std::vector<VisibilityTerms>& weights) {
  const std::vector<Vec3f>& sky = sky_directions();
  const Vec3f normal = surface.mesh().normals[vertex];
  VisibilityTerms visible{}, below{};
  int above = 0, free = 0;
  for (int k = 0; k < kSkyDirections; ++k) {
    const bool up = dot(sky[size_t(k)], normal) > 0, sees = up && surface.sees(vertex, k);
    above += up;
    free += sees;
    if (up && !sees) continue;
    VisibilityTerms& sum = up ? visible : below;
    for (size_t j = 0; j < kVisibilityTerms; ++j) sum[j] += weights[size_t(k)][j];
  }
  const float share = above > 0 ? float(free) / float(above) : 1;
  for (size_t j = 0; j < kVisibilityTerms; ++j) visible[j] += share * below[j];
  return visible;
}

}  // namespace

VisibilityTerms visibility_basis(Vec3f d) {
  return {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
}

std::vector<VisibilityTerms> visibility_harmonics(const Surface& surface) {
  const std::vector<VisibilityTerms> weights = weights_of_directions();
  std::vector<VisibilityTerms> out(surface.mesh().positions.size());
  parallel_ranges(int(out.size()), 1024, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) out[size_t(v)] = terms_of(surface, uint32_t(v), weights);
  });
  return out;
}

void add_visibility(const std::vector<VisibilityTerms>& terms, Pack& pack) {
  constexpr size_t kColumns = 12;  // hardware likes multiples of 4
  float largest = 1e-6f;
  for (const VisibilityTerms& of_vertex : terms)
    for (const float t : of_vertex) largest = std::max(largest, std::abs(t));
  std::vector<int8_t> out;
  for (const VisibilityTerms& of_vertex : terms) {
    for (const float t : of_vertex) out.push_back(snorm8(t / largest));
    out.resize(out.size() + kColumns - kVisibilityTerms, 0);
  }
  pack["visibility_scale"] = largest;
  pack.add("visibility", out, kColumns);
}

}  // namespace cei3d
