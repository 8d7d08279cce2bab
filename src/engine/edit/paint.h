// SPDX-License-Identifier: Apache-2.0
// `edit paint`: turns a scribble on a view into a layer with a region and an albedo branch of its own. [paper
// sec. 4.3, eq. 17; docs/method.md#edit-layers]
#pragma once

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "engine/edit/albedo_branch.h"
#include "engine/edit/routing.h"
#include "engine/render/render.h"

namespace cei3d {

class SceneLight;  // engine/render/scene_light.h

struct Scribble {
  Camera camera;  // of the painted view, unit frame
  // RGBA, sRGB, straight alpha, of the camera's size. Painted where alpha >= 0.5; in semi-transparent strokes
  // (partial alpha elsewhere than at smooth edges) alpha blends the color with the albedo below.
  Image image;
};

struct PaintRequest {
  std::vector<Scribble> scribbles;  // later scribbles cover earlier ones
  std::string id;                   // of the new layer
  uint64_t seed = 1;                // for the branch's weights and batches
  bool erase = false;  // restore the base's albedo and material; the scribbles' colors are ignored
  Routing routing = Routing::both;
  float theta = 0;     // with Routing::points: stroke_region(); 0: by the nearest labeled point
  bool unlit = false;  // show the painted color without light
  // null: the painted colors are display colors of the albedo. Else: of the radiance under this light.
  const SceneLight* seen_in = nullptr;
  BranchOptions branch{};        // of the fit of the painted colors
  bool learn_one_color = false;  // by a network, too; else paint of one color needs none
  MaterialChange material{};     // where the weight of the paint is above kMaterialWeight
  std::optional<Vec3f> color{};  // linear; instead of the scribbles' colors
};

struct PaintReport {
  int painted_pixels = 0;
  int missed_pixels = 0;     // painted pixels without a surface that faces the view
  int unchanged_pixels = 0;  // painted pixels whose color the surface has already; they are not painted
  size_t points = 0;         // edited handler points, H+
  size_t refined = 0;        // handler points that the strokes added, edited and beside
  float mean_error = 0, max_error = 0;  // of the branch on the painted surface, linear
  float out_of_reach = 0;  // share of the paint whose color no albedo in [0, 1] gives under the light
  double trace_seconds = 0, train_seconds = 0;  // stages
};

struct PaintResult {
  EditLayer layer;
  PaintReport report;
};

// Pure: the scene is not changed. Errors: no scribble, wrong size, no alpha or nothing painted, no painted
// pixel on the surface, a material of strokes that are too transparent for one, cancelled. Usage errors:
// those of check_change(), a material or color without a region.
PaintResult paint(const Device&, const Scene&, const PaintRequest&, Progress&);

}  // namespace cei3d
