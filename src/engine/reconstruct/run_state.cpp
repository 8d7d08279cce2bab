// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_state.h"

#include "core/base/error.h"

namespace cei3d {

namespace {

constexpr int kVersion = 2;  // version 1: the geometry stage alone, its tensors without a prefix
const std::string kGeometry = "geometry/", kScene = "scene/";

void add_prefixed(const std::string& prefix, Tensors from, Tensors& to) {
  for (auto& [name, tensor] : from) to[prefix + name] = std::move(tensor);
}

Tensors without_prefix(const std::string& prefix, const Tensors& from) {
  Tensors out;
  for (const auto& [name, tensor] : from)
    if (name.starts_with(prefix)) out[name.substr(prefix.size())] = tensor;
  return out;
}

SavedRun read_version_1(const Checkpoints::State& saved, const MakeGeometry& make_geometry) {
  SavedRun run;
  RunState& state = run.state;
  state.geometry = make_geometry();
  state.geometry->load(saved.tensors);
  state.step = saved.head.at("step").get<int64_t>();
  state.training_seconds = saved.head.at("elapsed").get<double>();
  state.start_seconds = saved.head.value("start", 0.0);
  run.position = {
      saved.head.at("stage").get<std::string>(), false, state.start_seconds + state.training_seconds, {}};
  return run;
}

SavedRun read_version_2(const Checkpoints::State& saved, const MakeGeometry& make_geometry) {
  const Json& head = saved.head;
  return {{head.at("stage").get<std::string>(), head.at("finished").get<bool>(),
           head.at("elapsed").get<double>(), head.at("rates")},
          load_state(saved.tensors, head.at("state"), make_geometry)};
}

}  // namespace

void save_state(const RunState& state, Tensors& tensors, Json& head) {
  head = {{"step", state.step},
          {"training_seconds", state.training_seconds},
          {"start_seconds", state.start_seconds},
          {"polish_deadline", state.polish_deadline},
          {"look_seconds", state.look_seconds},
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
}

RunState load_state(const Tensors& tensors, const Json& head, const MakeGeometry& make_geometry) {
  RunState state;
  state.step = head.at("step").get<int64_t>();
  state.training_seconds = head.at("training_seconds").get<double>();
  state.start_seconds = head.at("start_seconds").get<double>();
  state.polish_deadline = head.at("polish_deadline").get<double>();
  state.look_seconds = head.at("look_seconds").get<double>();
  state.scene = load_scene(without_prefix(kScene, tensors), head.at("scene"));
  if (head.at("has_geometry").get<bool>()) {
    state.geometry = make_geometry();
    state.geometry->load(without_prefix(kGeometry, tensors));
    state.geometry->set_light(state.scene.light_frame);
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
  try {
    const int version = saved.head.value("version", 1);
    if (version > kVersion)
      fail("the checkpoint was written by a newer program; resume with that, or start anew with --force");
    return version == 1 ? read_version_1(saved, make_geometry) : read_version_2(saved, make_geometry);
  } catch (const Json::exception& e) {
    fail("the checkpoint is damaged ({}); start anew with --force", e.what());
  }
}

}  // namespace cei3d
