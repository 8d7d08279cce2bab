// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_state.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {

namespace {

constexpr int kVersion = 2;  // version 1: the geometry stage alone, its tensors without a prefix
const std::string kGeometry = "geometry/", kScene = "scene/", kDescent = "descent/",
                  kSeparatedAlbedo = "separated_albedo", kBrightness = "brightness";

void add_prefixed(const std::string& prefix, Tensors from, Tensors& to) {
  for (auto& [name, tensor] : from) to[prefix + name] = std::move(tensor);
}

Tensors without_prefix(const std::string& prefix, const Tensors& from) {
  Tensors out;
  for (const auto& [name, tensor] : from)
    if (name.starts_with(prefix)) out[name.substr(prefix.size())] = tensor;
  return out;
}

const std::string kCheckpoint = "The checkpoint";

SavedRun read_version_1(const Checkpoints::State& saved, const MakeGeometry& make_geometry) {
  JsonReader head(saved.head, kCheckpoint);
  SavedRun run;
  RunState& state = run.state;
  state.geometry = make_geometry();
  state.geometry->load(saved.tensors);
  state.step = head.require<int64_t>("step");
  state.training_seconds = head.require<double>("elapsed");
  state.start_seconds = head.optional("start", 0.0);
  run.position = {
      head.require<std::string>("stage"), false, state.start_seconds + state.training_seconds, {}};
  head.finish();
  return run;
}

SavedRun read_version_2(const Checkpoints::State& saved, const MakeGeometry& make_geometry) {
  JsonReader head(saved.head, kCheckpoint);
  head.has("version");
  const RunPosition position{head.require<std::string>("stage"), head.require<bool>("finished"),
                             head.require<double>("elapsed"), head.member("rates")};
  const Json& state = head.member("state");
  head.finish();
  return {position, load_state(saved.tensors, state, make_geometry)};
}

}  // namespace

std::vector<Vec3f> exposures_of(const RunState& state) {
  std::vector<Vec3f> out;
  for (const ViewExposure& e : state.scene.exposures) out.push_back(e.factors);
  if (out.empty()) out.assign(state.brightness.size(), {1, 1, 1});
  for (size_t v = 0; v < std::min(out.size(), state.brightness.size()); ++v)
    out[v] = out[v] * state.brightness[v];
  return out;
}

void save_state(const RunState& state, Tensors& tensors, Json& head) {
  head = {{"step", state.step},
          {"training_seconds", state.training_seconds},
          {"start_seconds", state.start_seconds},
          {"polish_deadline", state.polish_deadline},
          {"look_seconds", state.look_seconds},
          {"descent_share", state.descent_share},
          {"descent_seconds", state.descent_seconds},
          {"light_frame_known", state.light_frame_known},
          {"several_materials", state.several_materials},
          {"alignments", state.alignments},
          {"has_geometry", bool(state.geometry)}};
  if (state.geometry) {
    Tensors geometry;
    state.geometry->save(geometry);
    add_prefixed(kGeometry, std::move(geometry), tensors);
  }
  Tensors scene;
  Json scene_head = Json::object();
  save_scene(state.scene, scene, scene_head);
  add_prefixed(kScene, std::move(scene), tensors);
  head["scene"] = std::move(scene_head);
  if (!state.separated_albedo.empty()) tensors[kSeparatedAlbedo] = tensor_of(state.separated_albedo);
  if (!state.brightness.empty())
    tensors[kBrightness] = {{int64_t(state.brightness.size())}, state.brightness, {}};
  head["descent_step"] = state.descent.step;
  add_prefixed(kDescent, state.descent.tensors, tensors);
}

RunState load_state(const Tensors& tensors, const Json& head, const MakeGeometry& make_geometry) {
  JsonReader reader(head, "The state in the checkpoint");
  RunState state;
  state.step = reader.require<int64_t>("step");
  state.training_seconds = reader.require<double>("training_seconds");
  state.start_seconds = reader.require<double>("start_seconds");
  state.polish_deadline = reader.require<double>("polish_deadline");
  state.look_seconds = reader.require<double>("look_seconds");
  const double of_older = reader.optional("joint_seconds", 0.0);  // before polishing had it, too
  state.descent_seconds = reader.optional("descent_seconds", of_older);
  state.descent_share = reader.optional("descent_share", 1.0);
  state.light_frame_known = reader.optional("light_frame_known", false);
  state.several_materials = reader.optional("several_materials", false);
  state.descent = {reader.optional<int64_t>("descent_step", 0), without_prefix(kDescent, tensors)};
  state.alignments = reader.optional("alignments", 0);
  const bool has_geometry = reader.require<bool>("has_geometry");
  const Json& scene = reader.member("scene");
  reader.finish();
  state.scene = load_scene(without_prefix(kScene, tensors), scene, "The object in the checkpoint");
  if (tensors.contains(kSeparatedAlbedo)) {
    if (!state.scene.surface) fail("The checkpoint has an albedo for vertices, but no surface.");
    state.separated_albedo =
        vectors_from(tensors, kSeparatedAlbedo, int64_t(state.scene.surface->mesh().positions.size()));
  }
  if (tensors.contains(kBrightness)) state.brightness = require_tensor(tensors, kBrightness).f32;
  if (has_geometry) {
    state.geometry = make_geometry();
    state.geometry->load(without_prefix(kGeometry, tensors));
  }
  return state;
}

Checkpoints::State checkpoint_of(const RunPosition& position, const RunState& state) {
  Checkpoints::State out;
  Json head;
  save_state(state, out.tensors, head);
  out.head = {{"version", kVersion},         {"stage", position.stage}, {"finished", position.finished},
              {"elapsed", position.elapsed}, {"rates", position.rates}, {"state", std::move(head)}};
  return out;
}

SavedRun read_checkpoint(const Checkpoints::State& saved, const MakeGeometry& make_geometry) {
  constexpr const char* kHint = "Start the reconstruction anew.";
  try {
    const int version = saved.head.value("version", 1);
    if (version > kVersion) fail("The checkpoint was written by a newer program; resume with that one.");
    return version == 1 ? read_version_1(saved, make_geometry) : read_version_2(saved, make_geometry);
  } catch (const Json::exception& e) {
    throw Error(ErrorCode::failed, fmt::format("The checkpoint is damaged ({}).", e.what()), kHint);
  } catch (const Error& e) {
    throw Error(e.code(), e.what(), kHint);
  }
}

}  // namespace cei3d
