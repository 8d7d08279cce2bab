// SPDX-License-Identifier: Apache-2.0
// The edits of an evaluation that lie beside the photographs of a capture.
#pragma once

#include "engine/evaluate/evaluation.h"

namespace cei3d {

struct OwnEdits {
  std::optional<PaintStroke> paint;
  EditTruth paint_truth;
  std::optional<PartTrial> part;
};

// CAPTURE/edits/paint: view.json ("view"), scribble.png, and with a truth gt/ and mask/. CAPTURE/edits/part:
// prompts.json ("view", "positive" and "negative" as pixel indices [x, y], "target_color_srgb"), gt/ and
// mask/test/ or mask/. Nothing where there is no such folder. Error: files that say something else.
OwnEdits own_edits(const std::filesystem::path& capture);

// For a capture without edits: a disc of two colors in the middle of the object as the first training view
// shows it, of a quarter of its size. Written to `file`.
PaintStroke made_scribble(const Capture& capture, const std::filesystem::path& file);

}  // namespace cei3d
