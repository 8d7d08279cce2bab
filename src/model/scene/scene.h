// SPDX-License-Identifier: Apache-2.0
// The object: reconstruct makes it, edits extend it, render shows it. Immutable by convention: an edit copies
// the struct, which shares its tensors, and adds a layer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/pose.h"
#include "model/geometry/shape/surface.h"
#include "model/light/light_turns.h"
#include "model/light/sg_mixture.h"
#include "model/scene/layer.h"
#include "model/scene/material_field.h"
#include "model/scene/normalization.h"
#include "model/scene/residual.h"
#include "model/scene/view.h"

namespace cei3d {

// How well pictures are matched at the object that the residual had not been trained on, in dB of
// display-encoded colors: by light and material alone, and with the residual.
struct Explained {
  double physical = 0, with_residual = 0;
};

struct Scene {
  Normalization normalization;          // between the capture frame and the unit frame of everything else
  Vec3d up{0, 0, 1};                    // capture frame
  std::shared_ptr<const Field> sdf;     // output 0: signed distance, negative inside; the rest: features
  std::shared_ptr<const Field> albedo;  // 3 outputs in [0, 1], linear
  // Mesh of the zero level set with its visibility table; replaced by changes of shape.
  std::shared_ptr<const Surface> surface;
  SgMixture light;                   // that of the last edit that has one, when the layers have been put on
  std::optional<Vec3f> light_error;  // of its strength as reconstructed, relative; none: not known
  LightFrame light_frame;  // of the light as reconstructed; one that an edit has put there stands still
  MaterialField material;
  // What they cannot explain; null: nothing, or not any more, since the light was changed.
  std::shared_ptr<const Residual> residual;
  std::optional<Explained> explained;             // of the reconstruction; none: not measured
  std::shared_ptr<const HandlerPoints> handlers;  // on the present shape
  Poses poses;  // shape versions, the last one with `surface`; empty while the shape is the reconstructed one
  std::vector<EditLayer> layers;  // in order; later layers cover earlier ones
};

// The scene with one more edit on top. Error: a change of shape that does not fit the surface.
Scene with_layer(Scene scene, EditLayer layer);

// The light of the scene as the object had it in the picture of a camera (of any frame that is not rotated
// against the capture's).
SgMixture light_in_view(const Scene&, const Camera&);
Scene in_view(Scene, const Camera&);  // under that light

// Writes a scene as named tensors and a small JSON head (sizes, material, transform). Layers are not part of
// it: the project's stack keeps them. what: the head in errors. Errors of loading: missing tensor, wrong
// shape, unknown key.
void save_scene(const Scene&, Tensors& tensors, Json& head);
Scene load_scene(const Tensors& tensors, const Json& head,
                 const std::string& what = "The description of the object");

}  // namespace cei3d
