// SPDX-License-Identifier: Apache-2.0
// The scene's light on its surface; made once and used for every view. Each shape version of the object
// ("pose") is lit as it was when it was made, and a hit is lit in the pose that gave its triangle its present
// shape: an edit changes no pixel outside its region. For the same reason bounces are those of the unedited
// albedo, and what an edited point reflects has the albedo and the material that it had when that point was
// edited last.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/lru_cache.h"
#include "engine/render/lighting.h"
#include "model/scene/scene.h"

namespace cei3d {

using Transports = std::vector<std::shared_ptr<const Transport>>;  // by pose, pose 0 first
using SeenMaterials = std::shared_ptr<const VertexMaterials>;      // of the vertices of a pose

// The light on one pose; does not depend on the layers, except through the shapes and the light.
struct PoseLight {
  std::shared_ptr<const Surface> surface;
  VertexLight vertices;  // what the light on the next pose starts from
  std::shared_ptr<const Lighting> lighting;
};
using PoseLights = std::vector<std::shared_ptr<const PoseLight>>;  // by pose

// Of pose k. before: of the pose before it; null for pose 0.
std::shared_ptr<const PoseLight> light_on_pose(const Device&, const Scene&, size_t k, const Transport&,
                                               const PoseLight* before);

// What the materials of a pose's vertices depend on.
struct SeenMaterialsKey {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Field> albedo;
  MaterialField material;
  std::string layers;  // content of all of them
  bool operator==(const SeenMaterialsKey&) const = default;
};
using SeenMaterialsCache = LruCache<SeenMaterialsKey, const VertexMaterials>;

// Hits by the pose that lights them and the last layer that has to do with them; -1: none.
struct HitGroups {
  std::vector<std::pair<int, int>> keys;  // pose, layer
  std::vector<uint32_t> of;               // #hits, index of the hit's key
};

// How hits were lit, for the next time that the same hits are.
struct LitHits {
  std::vector<ShadingTerms<float>> terms;  // #hits, of albedo that light falls on
  Appearance look;
  PoseLights lights;
  HitGroups groups;
  std::vector<SeenMaterials> seen;  // by group: what reflections see; null: the materials as reconstructed
  size_t kept = 0;                  // hits whose terms were taken over

  Shading shading() const;  // with albedo that shows its own color in every light
};

class SceneLight {
 public:
  // transports: of the scene's poses; see scene_transports(). They can serve several lights.
  SceneLight(const Device&, const Scene&, const Transports& transports);
  // lights: light_on_pose() of each. seen: where materials of vertices are kept; may be null, else it must
  // outlive this.
  SceneLight(const Device&, const Scene&, PoseLights lights, SeenMaterialsCache* seen);

  Shading shade(std::span<const Hit> hits, const Appearance&) const;
  // The radiance of every hit as a linear function of its albedo.
  std::vector<ShadingTerms<float>> terms(std::span<const Hit> hits, const Appearance&) const;
  // before: of the same hits, in any light and with any layers of the same shape; may be null. Terms of hits
  // that are lit as they were are taken over; the result has the same bits.
  LitHits light_hits(std::span<const Hit> hits, Appearance, const LitHits* before) const;

 private:
  HitGroups groups_of(std::span<const Hit> hits, std::span<const int> layers) const;
  void light_group(uint32_t group, std::span<const uint32_t> which, std::span<const Hit> hits,
                   LitHits& out) const;
  SeenMaterials materials_as_of(int layer, int pose) const;

  const Device& device_;
  Scene scene_;
  int everywhere_ = -1;  // the last layer that has no region
  PoseLights lights_;
  SeenMaterialsCache* seen_ = nullptr;
  std::vector<std::vector<uint32_t>> triangles_;  // [pose][present triangle]: its id in that pose
};

// One for each pose; depends on the scene's shape only. A second for pose 0, less for what changed after it.
Transports scene_transports(const Scene&);
std::shared_ptr<const Transport> transport_of_pose(const Scene&, size_t k);
const std::shared_ptr<const Surface>& surface_of_pose(const Scene&, size_t k);

}  // namespace cei3d
