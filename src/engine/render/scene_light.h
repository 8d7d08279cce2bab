// SPDX-License-Identifier: Apache-2.0
// How the scene's light reaches its surface; made once and used for every view. Each pose of the object is
// lit as it was when it was made, and a hit is lit in the pose that gave its triangle its present shape: an
// edit changes no pixel outside its region. For the same reason the bounce is that of the unedited base
// colour, and what an edited point mirrors has the colours that it had when that point was edited last.
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
using VertexColors = std::shared_ptr<const std::vector<Vec3f>>;    // #V of a pose

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

// The colors of a pose's vertices by what they are made of.
struct VertexColorsKey {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Field> albedo;
  std::string layers;  // content of all of them
  bool operator==(const VertexColorsKey&) const = default;
};
using VertexColorsCache = LruCache<VertexColorsKey, const std::vector<Vec3f>>;

// Hits by the pose that lights them and the last layer that applies to them; -1: none.
struct HitGroups {
  std::vector<std::pair<int, int>> keys;  // pose, layer
  std::vector<uint32_t> of;               // #hits, index of the hit's key
};

// How hits were lit, for the next time that the same hits are.
struct LitHits {
  Shading shading;  // of lit colors: what is unlit is not in it
  Appearance look;
  PoseLights lights;
  HitGroups groups;
  std::vector<VertexColors> mirrored;  // by group: what reflections see; null: the colors as reconstructed
  size_t kept = 0;                     // hits whose light was taken over
};

class SceneLight {
 public:
  // transports: of the scene's poses; see scene_transports(). They can serve several lights.
  SceneLight(const Device&, const Scene&, const Transports& transports);
  // lights: light_on_pose() of each. colors: where colors of vertices are kept, may be null; it has to
  // outlive this.
  SceneLight(const Device&, const Scene&, PoseLights lights, VertexColorsCache* colors);

  Shading shade(std::span<const Hit> hits, const Appearance&) const;
  // The same bits. before: of the same hits, in any light and with any layers of the same shape; may be null.
  // What it has of hits that are lit as they were is not computed again.
  LitHits light_hits(std::span<const Hit> hits, Appearance, const LitHits* before) const;

 private:
  HitGroups groups_of(std::span<const Hit> hits, std::span<const int> layers) const;
  void light_group(uint32_t group, std::span<const uint32_t> which, std::span<const Hit> hits,
                   LitHits& out) const;
  VertexColors colors_as_of(int layer, int pose) const;

  const Device& device_;
  Scene scene_;
  int everywhere_ = -1;  // the last layer that has no region
  PoseLights lights_;
  VertexColorsCache* colors_ = nullptr;
  std::vector<std::vector<uint32_t>> triangles_;  // [pose][present triangle]: its id in that pose
};

// One for each pose; depends on the scene's shape only. A second for pose 0, less for what changed after it.
Transports scene_transports(const Scene&);
std::shared_ptr<const Transport> transport_of_pose(const Scene&, size_t k);
const std::shared_ptr<const Surface>& surface_of_pose(const Scene&, size_t k);

// What is shown, with the colors that no light falls on.
Shading with_unlit(Shading lit, const Appearance&);

}  // namespace cei3d
