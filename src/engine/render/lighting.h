// SPDX-License-Identifier: Apache-2.0
// The shading model: what a surface point sends to the camera under a light of lobes. Direct light in closed
// form, dimmed by what the vertices around the point see of the sky, plus one diffuse bounce; reflections in
// closed form, replaced by what the surface itself shows where rays of the reflection lobe meet it: its
// diffuse radiance and one more reflection.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/compute/device.h"
#include "engine/render/irradiance_map.h"
#include "engine/render/self_reflection.h"
#include "engine/render/vertex_light.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"
#include "model/scene/appearance.h"

namespace cei3d {

struct Shading {
  std::vector<Vec3f> diffuse, specular;  // #hits, linear radiance
};

// What reaches a hit: irradiance = openness * (of the free sky) + bounce, reflected = open_mirror * (of the
// free sky) + what the surface shows. The colour is linear in the base colour: see at().
struct HitLight {
  std::vector<Vec3f> irradiance, reflected;  // #hits
  std::vector<Vec3f> openness;               // #hits, per channel
  std::vector<float> open_mirror;            // #hits, share of the reflection lobe that sees the sky
  std::vector<Vec2f> env;                    // #hits, scale and bias of the reflectance
  std::vector<float> diffuse_view;           // #hits, of the diffuse light, see core/math/brdf.h

  struct Terms {
    Vec3f diffuse_gain, specular_gain, specular_floor;  // times base colour, times base colour, plain
  };
  Terms at(size_t hit, const Material& material) const;
};

class Lighting {
 public:
  // base_color: #V, of the unedited object: what bounces and what reflections see. material: the object's
  // own. The transport can be shared by lights; without one it is computed (a second).
  Lighting(const Device&, const Surface&, const SgMixture&, std::span<const Vec3f> base_color,
           const Material&, std::shared_ptr<const Transport> transport = nullptr);
  Lighting(const Device&, const Surface&, const SgMixture&, const Material&, VertexLight);
  ~Lighting();

  // A hit's result depends on nothing but that hit, its base colour and its material. seen: #V, what
  // reflections see in place of the base colours above; empty: those.
  Shading shade(std::span<const Hit> hits, const Appearance&, std::span<const Vec3f> seen = {}) const;
  // ... all of the object's own material. albedo: #hits base colour.
  Shading shade(std::span<const Hit> hits, std::span<const Vec3f> albedo) const;
  // As if the object were of that material.
  HitLight light_at(std::span<const Hit> hits, const Material&, std::span<const Vec3f> seen = {}) const;
  HitLight light_at(std::span<const Hit> hits) const { return light_at(hits, material_); }
  // dL/d(normal) of each hit, tangent to the sphere, from dL/d(radiance that it sends out), for the object's
  // own material: through the mirror direction and the reflectance. Irradiance is taken at the mesh's normals
  // and does not enter; nor does what blocks the reflection. light: light_at(hits); albedo: #hits base
  // colour.
  std::vector<Vec3f> normal_slopes(std::span<const Hit> hits, const HitLight& light,
                                   std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance) const;
  // Another light close to the first: bounce and openness stay. For descent on the light.
  void set_lobes(const SgMixture&);

 private:
  struct Block;
  struct Group;
  void shade_group(const Group&, std::span<const Vec3f> albedo, const Material&, std::span<const Vec3f> seen,
                   Shading& out) const;
  std::vector<Vec3f> mirror_slopes(std::span<const Hit> hits, std::span<const Vec3f> d_reflected) const;

  const Device& device_;
  const Surface& surface_;
  Material material_;
  std::vector<float> lobe_planes_;
  int n_lobes_ = 0, padded_ = 0;
  IrradianceMap irradiance_;
  VertexLight vertices_;
  std::vector<Vec2f> env_table_;  // scale and bias of the reflectance by the viewer's cosine
};

}  // namespace cei3d
