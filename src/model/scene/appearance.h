// SPDX-License-Identifier: Apache-2.0
// Albedo and material of hits, edits included. The albedo is "dual": the base field, and in the regions of
// edits the branch of the edit. [paper sec. 4.2]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct Appearance {
  std::vector<Vec3f> albedo;       // #hits, linear
  std::vector<Material> material;  // #hits
  std::vector<int> layer;          // #hits, the last local layer that affects the hit; -1: none
  std::vector<float> unlit{};      // #hits, share of the albedo that is shown without light; empty: 0
  // #hits, [0, 1], share of the hit that is as photographed: neither color nor material nor shape edited, or
  // edits erased. The correction network is shown with this weight; empty where the scene has none.
  std::vector<float> original{};
};

// Layers are applied in their order, each in the shape version that it was made in: a branch covers the
// albedo below, a tint recolors it, a material change replaces, scales or blends the values it names. Surface
// that an edit added has its own albedo. A hit that no layer contains gets the base's value bit for bit,
// whatever else is in the batch.
Appearance appearance_at(const Device&, const Scene&, std::span<const Hit> hits);

// The vertices of a mesh as hits of one of their triangles, seen along the normal, for evaluation at
// vertices. A vertex without triangles gets triangle 0. mesh: the scene's present surface, with normals.
std::vector<Hit> vertex_hits(const Mesh& mesh);

}  // namespace cei3d
