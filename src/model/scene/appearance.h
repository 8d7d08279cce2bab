// SPDX-License-Identifier: Apache-2.0
// Albedo and material of hits, edits included. The albedo is "dual": the base field, and in the regions of
// edits the branch of the edit. [paper sec. 4.2]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

// What the photographs showed at the hits: their albedo and material before all edits.
struct Photographed {
  std::vector<Vec3f> albedo;       // #hits, linear
  std::vector<Material> material;  // #hits
  std::vector<uint8_t> in_place;   // #hits, 1: surface that no edit moved or added; elsewhere all is 0
};

struct Appearance {
  std::vector<Vec3f> albedo;       // #hits, linear
  std::vector<Material> material;  // #hits
  std::vector<int> layer;          // #hits, the last local layer that affects the hit; -1: none
  std::vector<float> unlit{};      // #hits, share of the albedo that is shown without light; empty: 0
  std::vector<float> covered{};    // #hits, share of the albedo that an edit has covered; empty: 0
  // As the object was reconstructed; for the correction, empty where the scene has none.
  Photographed photographed{};
};

// Layers are applied in their order, each in the shape version that it was made in: a branch covers the
// albedo below, a tint recolors it, a material change replaces, scales or blends the values it names. Surface
// that an edit added has its own albedo. A hit that no layer contains gets the base's value bit for bit,
// whatever else is in the batch.
Appearance appearance_at(const Device&, const Scene&, std::span<const Hit> hits);

// What an appearance depends on besides the hits.
struct AppearanceKey {
  explicit AppearanceKey(const Scene&);

  std::shared_ptr<const Field> albedo;
  MaterialField material;
  std::shared_ptr<const ShapeVersion> shape;
  bool has_residual = false;
  std::vector<uint64_t> layers;  // names each layer together with those below it; 0: it has no name
  int last_global = -1;          // the last layer that is not confined to its regions; -1: none
};

// appearance_at(), the same bit for bit, where the appearance of the same hits in another scene is known. It
// evaluates only hits in layers that just one of the two scenes has.
Appearance appearance_after(const Device&, const Scene&, std::span<const Hit> hits,
                            const AppearanceKey& before_key, const Appearance& before);

// The vertices of a mesh as hits of one of their triangles, seen along the normal, for evaluation at
// vertices. A vertex without triangles gets triangle 0. mesh: the scene's present surface, with normals.
std::vector<Hit> vertex_hits(const Mesh& mesh);

}  // namespace cei3d
