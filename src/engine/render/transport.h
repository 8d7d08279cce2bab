// SPDX-License-Identifier: Apache-2.0
// Transport of distant light to the vertices of a surface: directly where the sky is visible, and by one
// diffuse bounce from the surface that blocks it. Depends on geometry only, so one table serves every light.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "model/geometry/shape/surface.h"

namespace cei3d {

// Mean radiance of the sky around each of sky_directions(): #kSkyDirections, linear.
using SkyRadiance = std::vector<Vec3f>;

class Transport {
 public:
  // Casts a ray along every blocked direction above a vertex's horizon. which: #V, 1 for the vertices to
  // compute; the results of the others are 0. Empty: all. Error: interrupted.
  explicit Transport(std::shared_ptr<const Surface> surface, std::vector<uint8_t> which = {},
                     const Progress& progress = Progress());

  // Irradiance of every vertex from the sky that is visible from it: #V. which: as above.
  std::vector<Vec3f> sky(const SkyRadiance&, std::span<const uint8_t> which = {}) const;
  // Irradiance of every vertex without occlusion: #V. visible: sky() of the same radiance.
  std::vector<Vec3f> unoccluded_sky(const SkyRadiance&, std::vector<Vec3f> visible) const;
  // sky() and unoccluded_sky() of several skies at once, several times as fast: [sky][#V]. which: as above.
  std::vector<std::vector<Vec3f>> skies(std::span<const SkyRadiance>,
                                        std::span<const uint8_t> which = {}) const;
  std::vector<std::vector<Vec3f>> unoccluded_skies(std::span<const SkyRadiance>,
                                                   const std::vector<std::vector<Vec3f>>& visible) const;
  // Irradiance of every vertex from the rest of the surface: #V. radiance: #V, leaving each vertex. which: as
  // above.
  std::vector<Vec3f> bounce(std::span<const Vec3f> radiance, std::span<const uint8_t> which = {}) const;

  const Surface& surface() const { return *surface_; }
  size_t bytes() const {
    return which_.size() + start_.size() * sizeof(uint32_t) +
           blockers_.size() * (sizeof(uint16_t) + sizeof(uint32_t));
  }
  bool covers(size_t vertex) const { return which_.empty() || which_[vertex]; }

 private:
  template <class F>
  std::vector<std::vector<Vec3f>> sums_over_skies(std::span<const SkyRadiance>, F for_directions) const;
  template <class F>
  std::vector<Vec3f> per_vertex(F value) const;
  template <class F>
  void for_blocked(uint32_t vertex, F visit) const;
  // Blocked directions above the horizon of a vertex.
  std::span<const uint16_t> blocked_directions(size_t vertex) const {
    return std::span(directions_).subspan(start_[vertex], start_[vertex + 1] - start_[vertex]);
  }

  std::shared_ptr<const Surface> surface_;
  std::vector<uint8_t> which_;
  std::vector<uint32_t> start_;  // #V + 1
  // Each vertex's blocked directions above its horizon, in their order, and the vertex nearest to what blocks
  // each.
  std::vector<uint16_t> directions_;
  std::vector<uint32_t> blockers_;
};

}  // namespace cei3d
