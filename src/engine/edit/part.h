// SPDX-License-Identifier: Apache-2.0
// `edit part`: what clicks or a mask in one view mean becomes a part of the object, seen from everywhere; its
// color and material may change in the same edit. [paper sec. 4.3, CPS]
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "core/math/camera.h"
#include "engine/segment/prompts.h"
#include "model/scene/scene.h"

namespace cei3d {

// How the part is put together with one that there is already.
struct PartCombination {
  enum class How { add, subtract, intersect } how = How::add;  // old + new, old - new, old and new
  std::string part;
};

struct PartRequest {
  std::string id;    // of the new layer
  std::string name;  // of the part
  std::string view;  // name of the view, for messages
  Camera camera;     // of it, unit-sphere frame
  Prompts clicks;    // in it; positive ones unless there is a mask
  Image mask;        // in place of clicks: 1 channel, of the view's size; inside where >= 0.5
  // Finds the part from the clicks in place of growing it on the handler points: #handlers scores in [0, 1].
  std::function<std::vector<float>(const Scene&, const PartRequest&, Progress&)> network;
  bool in_view = false;  // only what the view shows of it, for comparison
  std::optional<PartCombination> combination;
  MaterialChange change;
  std::optional<Vec3f> color;  // linear
  bool keep_texture = false;   // of the color: scale what is there to it, instead of replacing it
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

// Pure: the scene is not changed. Usage errors: no positive click, clicks outside the picture, a positive and
// a negative one on the same point, a mask of another size, no part to combine with. Errors: clicks on the
// background, a mask with nothing of the object inside, a part that is nothing or everything, cancelled.
PartResult select_part(const Device&, const Scene&, const PartRequest&, Progress&);

}  // namespace cei3d
