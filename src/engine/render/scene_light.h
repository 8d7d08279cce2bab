// SPDX-License-Identifier: Apache-2.0
// The scene's light on its surface, computed once for all views. Each shape version keeps the light from when
// it was made, and a hit is lit in the version that gave its triangle its present shape, so that an edit
// changes no pixel outside its region. For the same reason bounces use the unedited albedo, and surface seen
// in a reflection has the albedo and material that it had when the reflecting point was last edited.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "engine/render/lighting.h"
#include "engine/render/seen_history.h"
#include "model/scene/scene.h"

namespace cei3d {

using Transports = std::vector<std::shared_ptr<const Transport>>;  // by shape version

// The light on one shape version. Depends on the layers only through the shape and the light.
struct VersionLight {
  std::shared_ptr<const Surface> surface;
  VertexLight vertices;  // from which those of the next version are made
  std::shared_ptr<const Lighting> lighting;
};
using VersionLights = std::vector<std::shared_ptr<const VersionLight>>;  // by version

// Light on shape version k. before: light on version k - 1; null for version 0.
std::shared_ptr<const VersionLight> light_on_version(const Device&, const Scene&, size_t k, const Transport&,
                                                     const VersionLight* before);
// Light on shape version k from the light at its vertices.
std::shared_ptr<const VersionLight> light_on_version(const Device&, const Scene&, size_t k, VertexLight);
// Materials of the vertices of shape version 0, as reconstructed.
VertexMaterials rest_materials(const Device&, const Scene&);

// Hits grouped by the shape version that lights them and the last layer that affects them (-1: none).
struct HitGroups {
  std::vector<std::pair<int, int>> keys;  // version, layer
  std::vector<uint32_t> of;               // #hits, index of the hit's key
};

// The light on a batch of hits, from which the next frame with the same hits takes over unchanged terms.
struct LitHits {
  std::vector<ShadingTerms<float>> terms;  // #hits, of albedo shown with light
  Appearance look;
  VersionLights lights;
  HitGroups groups;
  std::vector<SeenId> seen;  // by group: materials seen in reflections
  size_t kept = 0;           // hits whose terms were taken over

  Shading shading() const;  // includes unlit paint
};

class SceneLight {
 public:
  // transports: scene_transports(); they can be shared by several lights.
  SceneLight(const Device&, const Scene&, const Transports& transports);
  // lights: light_on_version() of each shape version. seen: may be null, else it must outlive this.
  SceneLight(const Device&, const Scene&, VersionLights lights, SeenHistories* seen);

  // At the vertices of the scene's present surface.
  const VertexLight& vertices() const { return lights_.back()->vertices; }

  Shading shade(std::span<const Hit> hits, const Appearance&) const;
  // The radiance of every hit as a linear function of its albedo.
  std::vector<ShadingTerms<float>> terms(std::span<const Hit> hits, const Appearance&) const;
  // before: light of the same hits under any light and any layers of the same shape; may be null. Terms that
  // are unchanged are taken over; the result is the same bit for bit.
  LitHits light_hits(std::span<const Hit> hits, Appearance, const LitHits* before) const;

 private:
  HitGroups groups_of(std::span<const Hit> hits, std::span<const int> layers) const;
  // seen: materials seen in reflections; empty: as reconstructed.
  void light_group(uint32_t group, std::span<const uint32_t> which, std::span<const Hit> hits,
                   const VertexMaterials& seen, LitHits& out) const;
  using Histories = std::map<int, std::shared_ptr<const SeenHistory>>;  // by shape version
  void light_groups(const Histories&, const std::vector<std::vector<uint32_t>>& changed,
                    std::span<const Hit> hits, LitHits& out) const;
  Histories histories_of(const HitGroups&) const;
  std::shared_ptr<const SeenHistory> history_of(int version, int last) const;

  const Device& device_;
  Scene scene_;
  int everywhere_ = -1;  // the last layer that has no region
  VersionLights lights_;
  SeenHistories* seen_ = nullptr;
  std::vector<std::vector<uint32_t>> triangles_;  // [version][present triangle]: its id in that version
};

// One for each shape version; depends on the shape only. About a second for version 0, less for later ones,
// which recompute changed vertices.
Transports scene_transports(const Scene&);
std::shared_ptr<const Transport> transport_of_version(const Scene&, size_t k);
const std::shared_ptr<const Surface>& surface_of_version(const Scene&, size_t k);

}  // namespace cei3d
