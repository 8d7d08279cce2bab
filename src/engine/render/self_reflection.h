// SPDX-License-Identifier: Apache-2.0
// What an object shows of itself in the reflections of its points: its diffuse radiance and one more
// reflection.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"
#include "engine/render/vertex_light.h"
#include "model/geometry/shape/surface.h"
#include "model/material/material.h"

namespace cei3d {

// Keeps references to all that it is made of.
class SelfReflection {
 public:
  // env_table: env_brdf_table() of the material's roughness. colors: #V base colours of what is mirrored.
  SelfReflection(const Device&, const Surface&, const VertexLight&, LobePlanes light, const Material&,
                 const std::vector<Vec2f>& env_table, std::span<const Vec3f> colors);

  struct Seen {
    float open = 1;           // share of the reflection lobe that sees the sky
    Vec3f radiance{0, 0, 0};  // from the rest, times its share
  };
  // #hits; each depends on its hit alone.
  std::vector<Seen> seen_by(std::span<const Hit> hits) const;

 private:
  struct Rays;
  bool faint(const Hit&) const;  // shows next to nothing of what is mirrored there
  void add_lobe(const Hit&, uint32_t owner, Rays&) const;
  Hit met_by(Vec3f origin, Vec3f direction, const Surface::RayHit&) const;
  std::vector<Vec3f> mirrored(std::span<const Hit> met) const;
  std::vector<Vec3f> shown(std::span<const Hit> met) const;
  template <class Where>  // a Hit or a Surface::RayHit
  Vec3f at(std::span<const Vec3f> of_vertices, const Where& w) const {
    return at_corners(of_vertices, surface_.mesh().triangles[w.triangle], w.b1, w.b2);
  }

  const Device& device_;
  const Surface& surface_;
  const VertexLight& vertices_;
  LobePlanes light_;
  Material material_;
  float roughness_;  // that shading can take
  const std::vector<Vec2f>& env_table_;
  std::span<const Vec3f> colors_;
  std::vector<Vec3f> lobe_, faint_lobe_;  // directions of the reflection lobe around +Z; where it is faint
};

}  // namespace cei3d
