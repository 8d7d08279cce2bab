// SPDX-License-Identifier: Apache-2.0
// What the surface is like where rays meet it: base color and material, edits included. Base color is
// "dual": the base field, and in the regions of edits the branch of the edit. [paper sec. 4.2]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct Appearance {
  std::vector<Vec3f> albedo;       // #hits, linear
  std::vector<Material> material;  // #hits
  std::vector<int> layer;          // #hits, the last layer that is local and has to do with the hit; -1: none
  std::vector<float> unlit{};  // #hits, share of the base color that shows whatever the light; empty: none
  // #hits, how much of it is as it was photographed: neither color nor material nor shape edited, or erased
  // again. Empty where the scene has no residual, which this is for.
  std::vector<float> original{};
};

// Layers are applied in their order, each in the pose of the object that it was made in: a branch covers what
// lies below it, a tint recolors it, a material replaces, scales or blends the values it names. New matter
// has its own base color. A hit that no layer contains gets exactly (bit for bit) the base's own value,
// whatever else is in the batch.
Appearance appearance_at(const Device&, const Scene&, std::span<const Hit> hits);

// The vertices of a mesh as hits of one of their triangles, seen from above: for what is wanted by vertex. A
// vertex without triangles gets the first one. mesh: the scene's present surface, with normals.
std::vector<Hit> vertex_hits(const Mesh& mesh);

}  // namespace cei3d
