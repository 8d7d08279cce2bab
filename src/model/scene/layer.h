// SPDX-License-Identifier: Apache-2.0
// One edit: where it is, and what it puts in place of what lies below it. Every member but the id is
// optional.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/geometry/shape/region.h"
#include "model/geometry/shape/reshape.h"
#include "model/light/sg_mixture.h"
#include "model/material/change.h"

namespace cei3d {

inline constexpr int kLatestPose = -1;

struct EditLayer {
  std::string id;            // "0001-paint"
  bool everywhere = false;   // the whole object; else `region`
  Region region;             // contains nothing by default
  std::vector<Region> also;  // further regions of the same edit: those of scribbles in other views
  // The shape of the object that region and branch live in: the number of changes of geometry before it.
  // kLatestPose: the one that with_layer() puts the layer on.
  int pose = kLatestPose;
  std::string part;                     // name of the part that the region is; empty: none
  std::shared_ptr<const Field> albedo;  // 3 outputs in [0, 1], linear; null: base color of the layers below
  bool unlit = false;                   // its colors are what shows, in every light: no light falls on them
  bool erase = false;                   // the base's own color instead, whatever lies below
  std::optional<Tint> tint;             // on top of that
  MaterialChange material;
  std::optional<SgMixture> light;          // in place of the object's, whatever the region
  std::shared_ptr<const Reshape> reshape;  // null: the shape stays

  bool contains(Vec3f position, Vec3f normal) const { return weight(position, normal) > 0; }
  // How much of the edit's color is there, [0, 1]; strokes may be semi-transparent. Material is all or
  // nothing.
  float weight(Vec3f position, Vec3f normal) const;
};

// Errors of loading: missing tensors or keys, sizes that disagree.
void save_layer(const EditLayer&, Tensors& tensors, Json& head);
EditLayer load_layer(const Tensors& tensors, const Json& head);

}  // namespace cei3d
