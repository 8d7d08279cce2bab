// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/stage.h"

#include <algorithm>
#include <memory>

#include "core/base/cancel.h"
#include "core/base/json.h"

namespace cei3d {

namespace {

// Index of the stage to run first.
size_t first_stage(const std::vector<Stage>& stages, const std::optional<RunPosition>& position) {
  if (!position) return 0;
  const auto at =
      std::find_if(stages.begin(), stages.end(), [&](const Stage& s) { return s.name == position->stage; });
  if (at == stages.end())
    throw Error(
        ErrorCode::failed,
        fmt::format("The checkpoint ends in a stage '{}' that this program does not have.", position->stage),
        "Start the reconstruction anew.");
  return size_t(at - stages.begin()) + (position->finished ? 1 : 0);
}

Error interrupted(const std::string& stage, bool has_checkpoint) {
  if (has_checkpoint)
    return {ErrorCode::interrupted, fmt::format("Interrupted in the stage '{}'; the state is saved.", stage),
            "The reconstruction can be resumed."};
  return {ErrorCode::interrupted,
          fmt::format("Interrupted in the stage '{}', before there was a state to save.", stage)};
}

}  // namespace

DescentStore descent_store(const RunContext& run, RunState& state, double* seconds,
                           const Stage::Checkpoint& checkpoint) {
  const Clock clock = run.progress.clock();
  const double now = clock(), begin = now - (seconds ? *seconds : 0);
  const auto last_save = std::make_shared<double>(now);
  const auto due = [=] { return clock() - *last_save > kCheckpointSeconds; };
  const auto save = [=, &state, &checkpoint](DescentState descent) {
    state.descent = std::move(descent);
    if (seconds) *seconds = clock() - begin;
    checkpoint();
    *last_save = clock();
  };
  return {state.descent, due, save};
}

void StageRunner::run(const std::vector<Stage>& stages, RunState& state,
                      const std::optional<RunPosition>& position) {
  has_checkpoint_ = position.has_value();
  double total = 0, before = 0;
  for (const Stage& s : stages) total += s.budget;
  const size_t first = first_stage(stages, position);
  for (size_t i = 0; i < stages.size(); ++i) {
    const double after = before + stages[i].budget / std::max(total, 1e-9);
    if (i >= first) {
      context_.progress.enter(stages[i].name, before, after);
      run_stage(stages[i], state);
      if (i + 1 < stages.size())
        save(stages[i], true, state);  // the caller saves the result of the last stage
    }
    before = after;
  }
}

void StageRunner::run_stage(const Stage& stage, RunState& state) {
  RunClock& progress = context_.progress;
  const double begin = progress.now();
  try {
    check_cancelled(progress);
    stage.run(context_, state, [&] { save(stage, false, state); });
  } catch (const Error& e) {
    if (e.code() == ErrorCode::interrupted) throw interrupted(stage.name, has_checkpoint_);
    throw;
  }
  progress.log(Json{{"stage", stage.name}, {"took", progress.now() - begin}}.dump());
}

void StageRunner::save(const Stage& stage, bool finished, const RunState& state) {
  checkpoints_.save(checkpoint_of({stage.name, finished, context_.progress.elapsed(), rates_}, state));
  has_checkpoint_ = true;
}

}  // namespace cei3d
