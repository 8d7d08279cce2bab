// SPDX-License-Identifier: Apache-2.0
// The object as it stands: what reconstruct makes, edits extend and render shows. Immutable by convention: an
// edit copies the struct (cheap: tensors are shared) and adds a layer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/pose.h"
#include "model/geometry/shape/surface.h"
#include "model/light/sg_mixture.h"
#include "model/material/material.h"
#include "model/scene/layer.h"
#include "model/scene/normalization.h"
#include "model/scene/residual.h"
#include "model/scene/view.h"

namespace cei3d {

struct Scene {
  Normalization normalization;          // between the capture's frame and the unit sphere that all else is in
  Vec3d up{0, 0, 1};                    // capture frame
  std::shared_ptr<const Field> sdf;     // output 0: signed distance, negative inside; the rest: features
  std::shared_ptr<const Field> albedo;  // base color, 3 outputs in [0, 1], linear
  // Zero level set as a mesh, with what each point sees of the sky; changed by edits.
  std::shared_ptr<const Surface> surface;
  SgMixture light;  // that of the last edit that has one, when the layers have been put on
  Material material;
  // What they cannot explain; null: nothing, or not any more, since the light was changed.
  std::shared_ptr<const Residual> residual;
  std::shared_ptr<const HandlerPoints> handlers;  // of the present shape
  Poses poses;  // of the object, the last one being `surface`; empty while it has the shape it was
                // reconstructed in
  std::vector<EditLayer> layers;  // in the order of their making; a later one covers an earlier one
};

// The scene with one edit more, on top of those it has. Error: a change of geometry that does not fit the
// surface.
Scene with_layer(Scene scene, EditLayer layer);

// A scene as named tensors plus a small JSON head (sizes, material, transform), and back. The layers are not
// part of it: the project's stack keeps them. Errors: missing tensor, wrong shape.
void save_scene(const Scene&, Tensors& tensors, Json& head);
Scene load_scene(const Tensors& tensors, const Json& head);

}  // namespace cei3d
