// SPDX-License-Identifier: Apache-2.0
// `edit part`: turns clicks, strokes, a mask or a clicked material in one view into a part of the object; its
// color and material may change in the same edit. [paper sec. 4.3, CPS; docs/method.md#parts]
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/base/settings.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "core/math/camera.h"
#include "engine/edit/part_scribble.h"
#include "engine/segment/point_graph.h"
#include "engine/segment/prompts.h"
#include "model/scene/scene.h"

namespace cei3d {

// How the selection is combined with an existing part.
struct PartCombination {
  enum class How { add, subtract, intersect } how = How::add;  // old + new, old - new, old and new
  std::string part;
};

// Differences from which two points are not of one material.
struct LikeLimits {
  float roughness = 0.1f, metalness = 0.25f;
  float color = 0.12f;  // distance in sRGB
};

struct PartOptions {
  GraphOptions graph;  // on which parts grow and their borders are placed
  LikeLimits like;
};
const SettingTable<PartOptions>& part_settings();

// Selection of a part by its material.
struct PartLikeness {
  Vec2f pixel;         // of the view (column, row); its surface is the example
  bool color = false;  // compare the albedo, too
};

struct PartRequest {
  std::string id;    // of the new layer
  std::string name;  // of the part
  std::string view;  // name of the view, for error messages
  Camera camera;     // of the view, unit frame
  Prompts clicks;    // in the view; at least one positive unless there is a scribble, a mask or a likeness
  // Besides clicks: strokes in the view, which give the part their color or pattern.
  std::optional<PartScribble> scribble;
  bool keep_color = false;           // do not take the scribble's color
  Image mask;                        // instead of clicks: 1 channel, of the view's size; inside where >= 0.5
  std::optional<PartLikeness> like;  // instead of clicks: by the material at a pixel
  // If set, finds the part from the prompts instead of growing it on the handler points. Returns #handlers
  // scores in [0, 1].
  std::function<std::vector<float>(const Scene&, const PartRequest&, Progress&)> network;
  bool in_view = false;  // only the part that the view shows, for comparison
  std::optional<PartCombination> combination;
  MaterialChange change;       // its blend is also that of the color
  std::optional<Vec3f> color;  // linear
  bool keep_texture = false;   // scale the present texture to the color instead of replacing it
  PartOptions options{};
};

struct PartReport {
  size_t points = 0;                                               // handler points of the part
  double share = 0;                                                // of the object's vertices
  double seed_seconds = 0, select_seconds = 0, color_seconds = 0;  // stages
};

struct PartResult {
  EditLayer layer;
  PartReport report;
};

// Pure: the scene is not changed. Usage errors: no positive click, clicks outside the image, a positive and a
// negative click on the same point, a scribble or mask of another size, no part to combine with, texture kept
// under a pattern. Errors: clicks on the background, a scribble or mask that shows none of the object, a
// material that the whole object has, a part that is empty or the whole object, cancelled.
PartResult select_part(const Device&, const Scene&, const PartRequest&, Progress&);

}  // namespace cei3d
