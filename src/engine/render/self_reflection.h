// SPDX-License-Identifier: Apache-2.0
// Self reflection: rays of a hit's reflection lobe that meet the surface again get its radiance there, shaded
// with its own material. At most two reflections in a row.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"
#include "engine/render/direction_map.h"
#include "engine/render/hit_batch.h"
#include "engine/render/vertex_light.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

class SelfReflection {
 public:
  // All arguments must outlive the object. vertices: by bin of the turning light. radiance: radiance_map() of
  // the light. seen: materials of the surface as seen in reflections.
  SelfReflection(const Device&, const Surface&, std::span<const VertexLight> vertices, LobePlanes light,
                 const DirectionMap& radiance, const VertexMaterials& seen);

  struct Reflected {
    // Fraction of the sky's mean radiance over the lobe that is not blocked by the surface, per channel.
    Vec3f visibility{1, 1, 1};
    // Mean radiance over the whole lobe of the surface that blocks it; 0 where it is not blocked.
    Vec3f radiance{0, 0, 0};
  };
  // #hits. Each result depends only on its hit and material.
  std::vector<Reflected> seen_by(const HitBatch&) const;

 private:
  struct Rays;
  class Points;
  struct Met;
  void add_rays(const Hit&, const Material&, uint32_t owner, const std::vector<Vec2f>& points, Rays&) const;
  Vec3f sky_over(const HitBatch&, size_t hit, const std::vector<Vec2f>& points) const;
  Met met_by(const Rays&, const TurnedHits&) const;
  std::vector<Vec3f> mirrored(const Met&, const std::vector<size_t>& which, const TurnedHits&) const;
  std::vector<Vec3f> reflected_at(const Met&, const TurnedHits&) const;
  std::vector<Vec3f> radiance_of(const Met&, const TurnedHits&) const;
  Vec3f diffuse_radiance(const Surface::RayHit&, size_t bin) const;
  template <class Where>  // a Hit or a Surface::RayHit
  Vec3f at(std::span<const Vec3f> of_vertices, const Where& w) const {
    return at_corners(of_vertices, surface_.mesh().triangles[w.triangle], w.b1, w.b2);
  }
  Material material_at(const Surface::RayHit&) const;

  const Device& device_;
  const Surface& surface_;
  std::span<const VertexLight> vertices_;
  LobePlanes light_;
  const DirectionMap& radiance_;
  const VertexMaterials& seen_;
};

}  // namespace cei3d
