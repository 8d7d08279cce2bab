// SPDX-License-Identifier: Apache-2.0
// Shading of hits under a light of lobes: core/math/shading.h with the light that arrives at each hit. Direct
// light in closed form, dimmed by the visibility of the environment from the vertices around the hit, plus
// diffuse bounces; reflections in closed form, replaced by the radiance of the surface where rays of the
// reflection lobe meet it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/math/reflection_axis.h"
#include "core/math/shading.h"
#include "engine/render/hit_batch.h"
#include "engine/render/irradiance_map.h"
#include "engine/render/light_direction.h"
#include "engine/render/self_reflection.h"
#include "engine/render/vertex_light.h"
#include "model/light/sg_mixture.h"
#include "model/scene/appearance.h"

namespace cei3d {

struct Shading {
  std::vector<Vec3f> diffuse, specular;  // #hits, linear radiance
};

Shading shading_of(std::span<const ShadingTerms<float>>, std::span<const Vec3f> albedo);

// dL/d(everything that the radiance of a batch of hits depends on), #hits each.
struct ShadingGrads {
  explicit ShadingGrads(size_t hits)
      : d_albedo(hits),
        d_normal(hits),
        d_view(hits),
        d_material(hits),
        d_sky_irradiance(hits),
        d_sky_reflection(hits) {}
  std::vector<Vec3f> d_albedo;
  std::vector<Vec3f> d_normal;          // tangent to the unit sphere at the hit's normal
  std::vector<Vec3f> d_view;            // tangent to the unit sphere at the direction to the camera
  std::vector<Material> d_material;     // derivatives by roughness, specular and metalness
  std::vector<Vec3f> d_sky_irradiance;  // by IncidentLight::sky_irradiance
  std::vector<Vec3f> d_sky_reflection;  // by IncidentLight::sky_reflection
};

class Lighting {
 public:
  // The device must outlive the object.
  Lighting(const Device&, std::shared_ptr<const Surface>, const SgMixture&, VertexLight);
  // For hits under a turning light. by_bin: turned_vertex_lights().
  Lighting(const Device&, std::shared_ptr<const Surface>, const SgMixture&, std::vector<VertexLight> by_bin);
  // Computes the light at the vertices. albedo (#V), material: of the unedited object, used for bounces and
  // reflections. transport: can be shared by several lights; null: computed (about a second).
  Lighting(const Device&, std::shared_ptr<const Surface>, const SgMixture&, std::span<const Vec3f> albedo,
           const Material&, std::shared_ptr<const Transport> transport = nullptr);

  // The result of a hit depends only on that hit, its albedo and its material. seen: vertex materials for
  // surface seen in reflections; empty: those of the vertices.
  Shading shade(const HitBatch&, std::span<const Vec3f> albedo, const VertexMaterials& seen = {}) const;

  std::vector<IncidentLight<float>> incident_light(const HitBatch&, const VertexMaterials& seen = {}) const;
  // incident_light() of a Lighting without a surface: as if the object hid nothing of the environment and
  // reflected nothing of itself, and diffuse light came evenly from everywhere.
  std::vector<IncidentLight<float>> unoccluded_light(const HitBatch&) const;
  // The radiance of every hit as a linear function of its albedo.
  std::vector<ShadingTerms<float>> terms(const HitBatch&, std::span<const IncidentLight<float>>) const;
  std::vector<ShadingTerms<float>> terms(const HitBatch&, const VertexMaterials& seen = {}) const;
  // The adjoint. What the object hides, bounces and self reflection are held constant.
  ShadingGrads grad(const HitBatch&, std::span<const IncidentLight<float>>, std::span<const Vec3f> albedo,
                    std::span<const Vec3f> d_radiance) const;

  // Replaces the lobes, but keeps visibility, bounces and the tables of light by direction: for descent on a
  // light, whose steps are small.
  void set_lobes(const SgMixture&);
  // From now on the sky's irradiance is taken at the hits' normals, so that it depends on them: for descent
  // on a field, which the mesh does not follow. Without this it is taken at the mesh's.
  void use_hit_normals() { hit_normals_ = true; }

 private:
  LobePlanes lobes() const { return {lobe_planes_.data(), n_lobes_, padded_}; }
  std::vector<Vec3f> sky_reflection(const HitBatch&) const;
  std::vector<SurfaceReflectionGrad<float>> reflection_grad(const HitBatch&,
                                                            std::span<const Vec3f> d_reflection) const;
  ShadingGrads block_grad(const HitBatch&, std::span<const IncidentLight<float>>,
                          std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance) const;
  // How a hit's light depends on its normal and the direction to the viewer.
  DiffuseLight<float> diffuse_light(const HitBatch&, size_t hit) const;
  void add_diffuse_light_grad(const HitBatch&, size_t hit, const DiffuseLight<float>& d, Vec3f& d_normal,
                              Vec3f& d_view) const;
  IncidentLight<float> incident_at(const HitBatch&, size_t hit, Vec3f sky_reflection,
                                   const SelfReflection::Reflected&) const;

  const Device& device_;
  std::shared_ptr<const Surface> surface_;
  std::vector<float> lobe_planes_;
  int n_lobes_ = 0, padded_ = 0;
  IrradianceMap irradiance_;
  DirectionMap radiance_;              // of the light that visibility was computed for; see set_lobes()
  LightDirectionMap directions_;       // of the light that visibility was computed for; see set_lobes()
  std::vector<VertexLight> vertices_;  // by bin of the light's turns
  bool hit_normals_ = false;           // see use_hit_normals()
};

}  // namespace cei3d
