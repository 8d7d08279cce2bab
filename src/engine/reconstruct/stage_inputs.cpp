// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/stage_inputs.h"

#include "engine/reconstruct/appearance/find_light_frame.h"

namespace cei3d {

Vec3f turntable_axis(const RunContext& run) { return to_float(normalize(run.capture.up)); }

Turns light_turns(const RunContext& run, RunState& state, const std::shared_ptr<const Surface>& surface,
                  const ObjectHits& hits) {
  const std::vector<Camera>& cameras = run.views.train.cameras();
  LightFrame& frame = state.scene.light_frame;
  if (!state.light_frame_known)
    frame = find_light_frame({surface, hits.samples()}, hits.views, cameras, turntable_axis(run), {run.seed},
                             run.progress);
  state.light_frame_known = true;
  return turns_of(frame, cameras);
}

ObjectHits scene_hits(const RunContext& run, const Scene& scene, const HitOptions& options) {
  return object_hits(run.device, *scene.sdf, *scene.surface, run.views.train, options, run.progress);
}

void find_hits(const RunContext& run, RunState& state) {
  if (state.hits.hits.empty()) state.hits = scene_hits(run, state.scene, {run.preset.max_hits});
}

}  // namespace cei3d
