// SPDX-License-Identifier: Apache-2.0
// The state of a reconstruction, which its stages change and a checkpoint holds.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/json.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/reconstruct.h"
#include "engine/reconstruct/surface_and_hits.h"
#include "model/scene/scene.h"

namespace cei3d {

struct RunState {
  std::unique_ptr<GeometryStage> geometry;  // until its field becomes the scene's
  int64_t step = 0;                         // steps of the geometry stage that are done
  double training_seconds = 0;              // s that these steps took
  double start_seconds = 0;                 // s that the comparison of start shapes took
  double polish_deadline = 0;      // end of all polishing rounds, s since the start of the run; 0: not begun
  double look_seconds = 0;         // s that the last round took to estimate light and material
  bool light_frame_known = false;  // whether scene.light_frame is final
  bool several_materials = false;  // whether the last estimate found several
  int alignments = 0;              // of the poses that are done in the geometry stage
  // By how much the training photographs are brighter than light and material explain, beyond their exposures
  // (view_brightness.h); empty: not at all.
  std::vector<float> brightness;
  // The finished parts of the object; in the middle of a round of polishing what it estimates, instead.
  Scene scene;

  // Between the stages of light and appearance: LinearSplit::albedo, #V of scene.surface; else empty.
  std::vector<Vec3f> separated_albedo;
  double descent_share = 1;    // of the appearance stage's descent, decided when the light is known
  DescentState descent;        // of a stage that is in the middle of a descent
  double descent_seconds = 0;  // s that the descent took so far; of polishing and of the joint stage

  // Hits of the present stage on scene.surface, and its transport. Not in checkpoints: they are recomputed.
  ObjectHits hits;
  std::shared_ptr<const Transport> transport;
};

// By which colors of the training pixels are divided (PixelStore::set_exposures): the photographs' exposures
// and their brightness.
std::vector<Vec3f> exposures_of(const RunState&);

using MakeGeometry = std::function<std::unique_ptr<GeometryStage>()>;

void save_state(const RunState&, Tensors& tensors, Json& head);
RunState load_state(const Tensors& tensors, const Json& head, const MakeGeometry& make_geometry);

// Position of a run when its checkpoint was written.
struct RunPosition {
  std::string stage;
  bool finished = false;  // whether the stage is finished; else it is resumed in the middle
  double elapsed = 0;     // s of the run
  Json rates;             // measured (engine/reconstruct/rates.h); null in a run by steps
};

Checkpoints::State checkpoint_of(const RunPosition&, const RunState&);

struct SavedRun {
  RunPosition position;
  RunState state;
};
// Also reads checkpoints of older programs, which had only a geometry stage. Error: it is damaged.
SavedRun read_checkpoint(const Checkpoints::State&, const MakeGeometry&);

}  // namespace cei3d
