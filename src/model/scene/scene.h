// SPDX-License-Identifier: Apache-2.0
// The object: reconstruct makes it, edits extend it, render shows it. Immutable by convention: an edit copies
// the struct, which shares its tensors, and adds a layer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/tensors.h"
#include "model/field/field.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/shape_version.h"
#include "model/geometry/shape/surface.h"
#include "model/light/light_turns.h"
#include "model/light/sg_mixture.h"
#include "model/scene/layer.h"
#include "model/scene/material_field.h"
#include "model/scene/normalization.h"
#include "model/scene/residual.h"
#include "model/scene/view.h"

namespace cei3d {

// PSNR (dB, display-encoded, on the object) of training views: by light and material alone, and with a
// correction that was not made from the view itself.
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
  SgMixture light;  // present light: of the last layer that has one, else as reconstructed
  // Relative standard error of the reconstructed light, per channel; none: unknown.
  std::optional<Vec3f> light_error;
  LightFrame light_frame;  // of the reconstructed light; the light of an edit is fixed to the object
  MaterialField material;
  // Correction; null: none, or the light was changed.
  std::shared_ptr<const Residual> residual;
  std::optional<Explained> explained;             // of the reconstruction; none: not measured
  RefinedCameras refined;                         // of the capture, as the reconstruction found out
  std::vector<ViewExposure> exposures;            // of training views; empty: all have the same
  std::shared_ptr<const HandlerPoints> handlers;  // on the present shape
  ShapeVersions shape_versions;  // the last one has `surface`; empty while the shape is the reconstructed one
  std::vector<EditLayer> layers;  // in order; later layers cover earlier ones
};

// The scene with one more edit on top. Error: a change of shape that does not fit the surface.
Scene with_layer(Scene scene, EditLayer layer);

// The light as it was relative to the object in the photograph of a camera (in the capture frame, or any
// frame that is not rotated against it).
SgMixture light_in_view(const Scene&, const Camera&);
Scene in_view(Scene, const Camera&);  // the scene under light_in_view()

// Writes a scene as named tensors and a small JSON head (sizes, material, transform). Layers are not
// included; the project stores them. what: the head in errors. Errors of loading: missing tensor, wrong
// shape, unknown key.
void save_scene(const Scene&, Tensors& tensors, Json& head);
Scene load_scene(const Tensors& tensors, const Json& head,
                 const std::string& what = "The description of the object");
// Scene::refined alone.
RefinedCameras refined_from_head(const Json& head, const std::string& what);

}  // namespace cei3d
