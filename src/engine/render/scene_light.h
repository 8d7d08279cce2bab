// SPDX-License-Identifier: Apache-2.0
// How the scene's light reaches its surface; made once and used for every view. Each pose of the object is
// lit as it was when it was made, and a hit is lit in the pose that gave its triangle its present shape: an
// edit changes no pixel outside its region. For the same reason the bounce is that of the unedited base
// colour, and what an edited point mirrors has the colours that it had when that point was edited last.
#pragma once

#include <memory>
#include <vector>

#include "engine/render/lighting.h"
#include "model/scene/scene.h"

namespace cei3d {

class SceneLight {
 public:
  // transports: of the scene's poses, pose 0 first; see scene_transports(). They can serve several lights.
  SceneLight(const Device&, const Scene&, const std::vector<std::shared_ptr<const Transport>>& transports);

  Shading shade(std::span<const Hit> hits, const Appearance&) const;
  // The radiance of every hit as a linear function of its albedo.
  std::vector<ShadingTerms<float>> terms(std::span<const Hit> hits, const Appearance&) const;

 private:
  VertexMaterials materials_as_of(int layer, int pose) const;

  const Device& device_;
  Scene scene_;
  int everywhere_ = -1;                                  // the last layer that has no region
  std::vector<std::shared_ptr<const Lighting>> lights_;  // by pose
  std::vector<std::vector<uint32_t>> triangles_;         // [pose][present triangle]: its id in that pose
};

// One for each pose; depends on the scene's shape only. A second for pose 0, less for what changed after it.
std::vector<std::shared_ptr<const Transport>> scene_transports(const Scene&);

}  // namespace cei3d
