// SPDX-License-Identifier: Apache-2.0
#include "engine/render/transport.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/base/cancel.h"
#include "core/base/parallel.h"

namespace cei3d {
namespace {

constexpr float kSolidAngle = 4 * kPi / kSkyDirections;
constexpr int kGrain = 1024;     // vertices per chunk
constexpr uint32_t kNone = ~0u;  // blocked, but the ray from above the surface hits nothing

uint32_t nearest_vertex(const Mesh& mesh, const Surface::RayHit& h) {
  return nearest_corner(mesh.triangles[h.triangle], h.b1, h.b2);
}

}  // namespace

template <class F>
std::vector<Vec3f> Transport::per_vertex(F value) const {
  std::vector<Vec3f> out(start_.size() - 1);
  parallel_ranges(int(out.size()), kGrain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) out[v] = covers(v) ? value(v) : Vec3f{0, 0, 0};
  });
  return out;
}

// Calls visit(direction, cosine to the normal) for blocked directions above the vertex's horizon.
template <class F>
void Transport::for_blocked(uint32_t vertex, F visit) const {
  if (!covers(vertex)) return;
  const auto& sky = sky_directions();
  for (int k = 0; k < kSkyDirections; ++k) {
    const float c = dot(surface_->mesh().normals[vertex], sky[k]);
    if (c > 0.02f && !surface_->sees(vertex, k)) visit(k, c);
  }
}

Transport::Transport(std::shared_ptr<const Surface> surface, std::vector<uint8_t> which,
                     const Progress& progress)
    : surface_(std::move(surface)), which_(std::move(which)) {
  const Mesh& mesh = surface_->mesh();
  const int n = int(mesh.positions.size());
  start_.assign(n + 1, 0);
  parallel_ranges(n, kGrain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) for_blocked(v, [&](int, float) { ++start_[v + 1]; });
  });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  blockers_.resize(start_.back());
  directions_.reserve(start_.back());
  std::vector<Vec3f> origins, directions;
  std::vector<Surface::RayHit> hits;
  for (int begin = 0; begin < n; begin += 16 * kGrain) {
    check_cancelled(progress);
    const int end = std::min(n, begin + 16 * kGrain);
    origins.clear();
    directions.clear();
    for (int v = begin; v < end; ++v)
      for_blocked(v, [&](int k, float) {
        origins.push_back(mesh.positions[v] + mesh.normals[v] * kRayLift);
        directions.push_back(sky_directions()[k]);
        directions_.push_back(uint16_t(k));
      });
    hits.resize(origins.size());
    surface_->intersect(origins, directions, 0, hits);
    for (size_t i = 0; i < hits.size(); ++i)
      blockers_[start_[begin] + i] = hits[i].t < 0 ? kNone : nearest_vertex(mesh, hits[i]);
  }
}

namespace {

bool is_among(std::span<const uint8_t> which, int vertex) { return which.empty() || which[size_t(vertex)]; }

// Calls visit(direction) for the bits that are set.
template <class F>
void for_visible(const uint8_t* bits, const F& visit) {
  for (int byte = 0; byte < kSkyDirections / 8; ++byte)
    for (int set = bits[byte]; set; set &= set - 1) visit(8 * byte + __builtin_ctz(set));
}

}  // namespace

std::vector<Vec3f> Transport::sky(const SkyRadiance& radiance, std::span<const uint8_t> which) const {
  const Mesh& mesh = surface_->mesh();
  const auto& sky = sky_directions();
  const uint8_t* bits = surface_->visibility().data();
  return per_vertex([&](int v) {
    Vec3f sum{0, 0, 0};
    if (!is_among(which, v)) return sum;
    for_visible(bits + size_t(v) * (kSkyDirections / 8),
                [&](int k) { sum += radiance[k] * max(dot(mesh.normals[v], sky[k]), 0.0f); });
    return sum * kSolidAngle;
  });
}

// for_directions(v, visit) calls visit(direction) for the directions to sum at vertex v.
template <class F>
std::vector<std::vector<Vec3f>> Transport::sums_over_skies(std::span<const SkyRadiance> radiance,
                                                           F for_directions) const {
  constexpr size_t kMaxLights = 16;  // at a time
  const Mesh& mesh = surface_->mesh();
  const auto& sky = sky_directions();
  std::vector<std::vector<Vec3f>> out(radiance.size(), std::vector<Vec3f>(mesh.positions.size()));
  for (size_t first = 0; first < radiance.size(); first += kMaxLights) {
    const size_t count = std::min(kMaxLights, radiance.size() - first);
    std::vector<std::array<Vec3f, kMaxLights>> by_direction(size_t{kSkyDirections});
    for (size_t k = 0; k < by_direction.size(); ++k)
      for (size_t s = 0; s < count; ++s) by_direction[k][s] = radiance[first + s][k];
    parallel_ranges(int(mesh.positions.size()), kGrain, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        if (!covers(size_t(v))) continue;
        std::array<Vec3f, kMaxLights> sum{};
        for_directions(v, [&](int k) {
          const float c = dot(mesh.normals[v], sky[k]) * kSolidAngle;
          if (c <= 0) return;
          for (size_t s = 0; s < kMaxLights; ++s) sum[s] += by_direction[size_t(k)][s] * c;
        });
        for (size_t s = 0; s < count; ++s) out[first + s][size_t(v)] = sum[s];
      }
    });
  }
  return out;
}

std::vector<std::vector<Vec3f>> Transport::skies(std::span<const SkyRadiance> radiance,
                                                 std::span<const uint8_t> which) const {
  const uint8_t* bits = surface_->visibility().data();
  return sums_over_skies(radiance, [&](int v, const auto& visit) {
    if (is_among(which, v)) for_visible(bits + size_t(v) * (kSkyDirections / 8), visit);
  });
}

std::vector<std::vector<Vec3f>> Transport::unoccluded_skies(
    std::span<const SkyRadiance> radiance, const std::vector<std::vector<Vec3f>>& visible) const {
  std::vector<std::vector<Vec3f>> out = sums_over_skies(radiance, [&](int v, const auto& visit) {
    for (const uint16_t k : blocked_directions(size_t(v))) visit(k);
  });
  for (size_t s = 0; s < out.size(); ++s)
    for (size_t v = 0; v < out[s].size(); ++v) out[s][v] += visible[s][v];
  return out;
}

std::vector<Vec3f> Transport::unoccluded_sky(const SkyRadiance& radiance, std::vector<Vec3f> visible) const {
  const auto& sky = sky_directions();
  return per_vertex([&](int v) {
    Vec3f blocked{0, 0, 0};
    for (const uint16_t k : blocked_directions(size_t(v)))
      blocked += radiance[k] * dot(surface_->mesh().normals[v], sky[k]);
    return visible[size_t(v)] + blocked * kSolidAngle;
  });
}

std::vector<Vec3f> Transport::bounce(std::span<const Vec3f> radiance, std::span<const uint8_t> which) const {
  const auto& sky = sky_directions();
  return per_vertex([&](int v) {
    Vec3f sum{0, 0, 0};
    if (!is_among(which, v)) return sum;
    for (uint32_t i = start_[v]; i < start_[v + 1]; ++i) {
      if (blockers_[i] == kNone) continue;
      const float cosine = dot(surface_->mesh().normals[v], sky[directions_[i]]);
      sum += radiance[blockers_[i]] * (cosine * kSolidAngle);
    }
    return sum;
  });
}

}  // namespace cei3d
