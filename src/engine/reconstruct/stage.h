// SPDX-License-Identifier: Apache-2.0
// A reconstruction is a list of stages over one state. A runner goes through them, saves the state after each
// and resumes at the first that is unfinished.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "engine/reconstruct/live_picture.h"
#include "engine/reconstruct/plan.h"
#include "engine/reconstruct/run_clock.h"
#include "engine/reconstruct/run_state.h"
#include "engine/reconstruct/training_views.h"

namespace cei3d {

// What all stages read.
struct RunContext {
  const Device& device;
  const Capture& capture;
  const ImageSource& images;
  const Normalization& normalization;
  TrainingViews& views;  // the start may change its cameras
  const Preset& preset;
  Plan plan;
  uint64_t seed;
  std::optional<LightMotion> light;  // none: to be found
  LightColorPrior light_color;
  bool refine_poses, fit_exposures;
  RunClock& progress;
  LivePicture& live;
};

constexpr double kCheckpointSeconds = 30;  // between checkpoints within a stage that makes them

struct Stage {
  using Checkpoint = std::function<void()>;
  using Run = std::function<void(const RunContext&, RunState&, const Checkpoint& checkpoint)>;

  std::string name;   // unique in the list; checkpoints name it
  double budget = 0;  // length, relative to the other stages': seconds in a run with a time limit
  // Reports fractions of itself, and throws the interrupted Error when progress.cancelled(). checkpoint:
  // saves the state in the middle of the stage, which then must know from the state where to resume.
  Run run;
};

// A descent in the middle of a stage continues from the state, and is saved into it every kCheckpointSeconds
// and before an interruption. seconds: what the descent took so far; null: not recorded. All arguments must
// outlive the store.
DescentStore descent_store(const RunContext&, RunState&, double* seconds, const Stage::Checkpoint&);

class StageRunner {
 public:
  StageRunner(const RunContext& context, Json rates, Checkpoints& checkpoints)
      : context_(context), rates_(std::move(rates)), checkpoints_(checkpoints) {}

  // Runs the stages in order, from the one after `position`, or in its middle; no position: all of them.
  // Errors: those of the stages; the interrupted Error says whether there is a state to resume from;
  // `position` names a stage that is not in the list.
  void run(const std::vector<Stage>&, RunState&, const std::optional<RunPosition>& position);

 private:
  void run_stage(const Stage&, RunState&);
  void save(const Stage&, bool finished, const RunState&);

  const RunContext& context_;
  Json rates_;
  Checkpoints& checkpoints_;
  bool has_checkpoint_ = false;
};

}  // namespace cei3d
