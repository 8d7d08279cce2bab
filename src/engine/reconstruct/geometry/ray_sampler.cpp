// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/ray_sampler.h"

#include <algorithm>

#include "core/math/volume.h"

namespace cei3d {

namespace {

constexpr int kMaxRaySamples = 64;  // rays that graze the object need many
constexpr int kMaxCandidates = 320;
constexpr int kCandidatesPerPass = 8;  // candidates of a ray that are evaluated at a time

}  // namespace

RaySampler::RaySampler(const FieldConfig& sdf, const SamplingOptions& options)
    : options_(options), values_(sdf) {}

void RaySampler::sample(const GeometryNetworks& networks, const GeometrySchedule& s,
                        const OccupancyGrid& grid, const RayBatch& batch, std::span<const float> jitter,
                        RaySamples& out) {
  march(s, grid, batch, jitter);
  // A few candidates of each ray at a time, until no light is left: those behind need no distance.
  evaluated_ = 0;
  while (!active_.empty()) {
    find_distances(networks, batch);
    std::erase_if(active_, [&](int r) { return finished(s, rays_[r], batch.empty[r]); });
  }
  out.depths.clear();
  out.first.assign(1, 0);
  for (int r = 0; r < batch.count(); ++r) {
    select(s, rays_[r], batch.empty[r], out.depths);
    out.first.push_back(out.count());
  }
}

void RaySampler::march(const GeometrySchedule& s, const OccupancyGrid& grid, const RayBatch& batch,
                       std::span<const float> jitter) {
  depths_.clear();
  counts_.resize(batch.rays.size());
  grid.march(batch.rays, {s.step, s.band, s.slack, kMaxCandidates}, jitter, depths_, counts_);
  distances_.resize(depths_.size());
  rays_.clear();
  active_.clear();
  int first = 0;
  for (int r = 0; r < batch.count(); ++r) {
    rays_.push_back({.first = first, .end = first + counts_[r]});
    first = rays_.back().end;
    active_.push_back(r);
  }
}

void RaySampler::find_distances(const GeometryNetworks& networks, const RayBatch& batch) {
  next_.clear();
  points_.clear();
  for (const int r : active_) {
    RayState& state = rays_[r];
    for (int k = 0; k < kCandidatesPerPass && state.first + state.known < state.end; ++k) {
      const int candidate = state.first + state.known++;
      next_.push_back(candidate);
      points_.push_back(batch.rays[r].origin + batch.rays[r].direction * depths_[candidate]);
    }
  }
  found_.resize(points_.size());
  values_.eval(networks, points_, found_);
  for (size_t k = 0; k < next_.size(); ++k) distances_[next_[k]] = found_[k];
  evaluated_ += int(next_.size());
}

bool RaySampler::finished(const GeometrySchedule& s, RayState& state, bool empty) const {
  while (state.passed + 1 < state.known)  // the slope at the last one needs the next one
    state.light.pass(alpha(s, state, state.passed++));
  return state.first + state.known == state.end || (!empty && state.light.left <= options_.keep_weight);
}

// Opacity of candidate i of a ray. Neighbors farther than a step apart lie on different stretches near the
// surface.
float RaySampler::alpha(const GeometrySchedule& s, const RayState& state, int i) const {
  const int at = state.first + i;
  const bool has_previous = i > 0 && depths_[at] - depths_[at - 1] < 1.5f * s.step;
  const bool has_next = i + 1 < state.known && depths_[at + 1] - depths_[at] < 1.5f * s.step;
  const NeusNeighbors<float> neighbors{.previous = has_previous ? distances_[at - 1] : 0,
                                       .value = distances_[at],
                                       .next = has_next ? distances_[at + 1] : 0,
                                       .has_previous = has_previous,
                                       .has_next = has_next};
  return neus_alpha_of_neighbors(neighbors, s.step, s.inv_s);
}

void RaySampler::select(const GeometrySchedule& s, const RayState& state, bool empty,
                        std::vector<float>& samples) const {
  Transmittance<float> light;
  const size_t max_size = std::min(samples.size() + kMaxRaySamples, size_t(kChunkSamples));
  for (int i = 0; i < state.known && samples.size() < max_size; ++i) {
    if (!empty && light.left <= options_.keep_weight) break;
    const float weight = light.pass(alpha(s, state, i)).weight;
    if (weight > options_.keep_weight || (empty && distances_[state.first + i] < 0))
      samples.push_back(depths_[state.first + i]);
  }
}

}  // namespace cei3d
