// SPDX-License-Identifier: Apache-2.0
// What a reconstruction has made so far: the one object that its stages work on and that a checkpoint holds.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/reconstruct.h"
#include "engine/reconstruct/surface_and_hits.h"
#include "model/scene/scene.h"

namespace cei3d {

struct RunState {
  std::unique_ptr<GeometryStage> geometry;  // until its field becomes the scene's
  int64_t step = 0;                         // steps of the geometry stage that are done
  double training_seconds = 0;              // that they took
  double start_seconds = 0;                 // that comparing the starts took
  double polish_deadline = 0;  // of all rounds, in seconds of the run; 0: polishing has not begun
  double look_seconds = 0;     // that the last round took to estimate light and material before its descent
  Scene scene;                 // what of the object is finished

  // Pixels of the appearance stage on scene.surface. A checkpoint leaves them out: they are found again.
  ObjectHits hits;
};

using MakeGeometry = std::function<std::unique_ptr<GeometryStage>()>;

void save_state(const RunState&, Tensors& tensors, Json& head);
RunState load_state(const Tensors& tensors, const Json& head, const MakeGeometry& make_geometry);

// Where a run was when its checkpoint was written.
struct RunPosition {
  std::string stage;
  bool finished = false;  // the stage; else it is resumed in the middle
  double elapsed = 0;     // s of the run
  Json rates;             // measured (engine/reconstruct/rates.h); null in a run by steps
};

Checkpoints::State checkpoint_of(const RunPosition&, const RunState&);

struct SavedRun {
  RunPosition position;
  RunState state;
};
// Reads those of programs that knew the geometry stage alone, too. Error: it is damaged.
SavedRun read_checkpoint(const Checkpoints::State&, const MakeGeometry&);

}  // namespace cei3d
