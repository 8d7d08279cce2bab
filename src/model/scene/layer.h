// SPDX-License-Identifier: Apache-2.0
// One edit: a region, and what it replaces there. Every member but the id is optional.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/shelf.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/geometry/shape/region.h"
#include "model/geometry/shape/reshape.h"
#include "model/light/sg_mixture.h"
#include "model/material/change.h"

namespace cei3d {

inline constexpr int kLatestVersion = -1;
inline constexpr float kMaterialWeight = 0.5f;

struct EditLayer {
  std::string id;            // "0001-paint"
  std::string content;       // hash of its stored form: equal hashes, equal layers; empty: not stored
  bool everywhere = false;   // the whole object; else `region`
  Region region;             // contains nothing by default
  std::vector<Region> also;  // further regions of the same edit, from scribbles in other views
  // Shape version that region and branch refer to: the number of changes of shape before the edit.
  // kLatestVersion: the present one, filled in by with_layer(). Stored as "pose".
  int shape_version = kLatestVersion;
  std::string part;             // name of the part that the region defines; empty: none
  Shelved<Field> albedo;        // 3 outputs in [0, 1], linear; null: albedo of the layers below
  bool unlit = false;           // the color is shown without light
  bool erase = false;           // restores the base's albedo
  bool erase_material = false;  // restores the base's material
  std::optional<Tint> tint;     // recolors the albedo that results from the members above
  MaterialChange material;
  std::optional<SgMixture> light;          // replaces the object's light, everywhere
  std::shared_ptr<const Reshape> reshape;  // null: no change of shape
  std::shared_ptr<const Field> sdf;        // of the surface that `reshape` moved; null: see ShapeVersion::sdf

  // Whether it has a color of its own, which covers the details of what is below.
  bool covers() const { return albedo || (tint && !tint->keep_texture); }
  bool contains(Vec3f position, Vec3f normal) const { return weight(position, normal) > 0; }
  // Weight of the edit's color at a point, [0, 1]; strokes may be semi-transparent. The material changes
  // where the weight is above kMaterialWeight. For many points: LayerWeights.
  float weight(Vec3f position, Vec3f normal) const;
  // box: in the shape version of the region. False: the weight is 0 in all of it.
  bool may_meet(const AxisBox& box) const;
};

// EditLayer::weight() of many points, see Region::Weights. layer: must outlive this.
class LayerWeights {
 public:
  explicit LayerWeights(const EditLayer& layer);
  float at(Vec3f position, Vec3f normal);

 private:
  bool everywhere_;
  std::vector<Region::Weights> regions_;
};

// Errors of loading: missing tensors or keys, sizes that disagree.
void save_layer(const EditLayer&, Tensors& tensors, Json& head);
EditLayer load_layer(const Tensors& tensors, const Json& head,
                     const std::string& what = "The description of the edit");

// The same layer, whose regions and color network, which are nearly all of it, may be dropped from memory
// where they are large. name: of what read() reads the layer from.
EditLayer shelved(EditLayer, const std::shared_ptr<Shelf>&, const std::string& name,
                  std::function<EditLayer()> read);

}  // namespace cei3d
