// SPDX-License-Identifier: Apache-2.0
// Edits: commands become parameters and input files, from which edits are made (edit_ops.h).
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/edit/albedo_branch.h"
#include "engine/io/npy.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"
#include "engine/session/light_choice.h"
#include "engine/session/session.h"
#include "engine/session/stopwatch.h"

namespace cei3d {
namespace {

// The context of edits.
struct Tools {
  const Device& device;
  RenderCache& frames;
  Progress& progress;
};

EditSummary add_edit_to(Project& project, const Tools& tools, const char* name, Json params,
                        EditInputs inputs) {
  Stopwatch watch;
  const EditOp& op = edit_op(name);
  const Scene scene = project.scene();
  EditSummary s;
  s.load_seconds = watch.lap();
  const EditJob job{project.stack().next_id(name), std::move(params), std::move(inputs)};
  EditOutcome made = op.make({tools.device, project.capture(), scene, tools.frames, tools.progress}, job);
  const double seconds = watch.lap();
  if (!made.report.contains("seconds")) made.report["seconds"] = {{name, seconds}};
  s.id = job.id;
  s.report = made.report;
  project.add_edit({job.id, name, op.version, job.params, op.depends(job.params), made.report, job.inputs},
                   made.layer);
  s.store_seconds = watch.lap();
  return s;
}

// Remakes the edits that a change of the history needs before the change, so that the stored history is
// always complete.
void make_anew(Project& project, const Tools& tools, const Stack& next) {
  while (const auto id = project.first_stale(next)) {
    const EditRecord record = project.edit(*id);
    const EditOp& op = edit_op(record.op);
    try {
      const Json params = present_params(op, record);
      const Scene below = project.scene_below(next, *id);
      const EditOutcome made = op.make({tools.device, project.capture(), below, tools.frames, tools.progress},
                                       {*id, params, project.edit_inputs(*id)});
      project.add_result(next, *id, made.layer, op.version);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::interrupted) throw;
      fail("Edit {} would have to be remade, which fails: {} Nothing was changed.", *id, e.what());
    }
  }
}

std::string version_note(const std::string& id, int version, const EditOp& op) {
  return fmt::format("Edit {} was made by version {} of '{}' and is remade by version {}: it may differ.", id,
                     version, op.name, op.version);
}

// Usage errors: options that exclude each other.
void check_paint(const PaintCommand& c) {
  const MaterialEffects& m = c.material;
  if (!(c.theta >= 0 && std::isfinite(c.theta))) fail_usage("--theta {} is not a distance.", c.theta);
  if (c.theta > 0 && c.routing != Routing::points) fail_usage("--theta goes with --routing points.");
  if (c.erase && c.target != PaintTarget::albedo) fail_usage("--erase paints no color; leave out --target.");
  if (c.erase && c.routing == Routing::none) fail_usage("--erase needs a region; use another --routing.");
  if (!m.color.empty()) fail_usage("Paint has the colors of its scribble; leave out --color.");
  if (m.blend) fail_usage("Paint is blended by the scribble's alpha; leave out --blend.");
  if (m.empty()) return;
  if (c.erase) fail_usage("--erase restores the material; leave out the material options.");
  if (c.routing == Routing::none) fail_usage("A material needs a region; use another --routing.");
  if (c.target == PaintTarget::radiance)
    fail_usage("With --target radiance, material has no effect; leave out the material options.");
  if (c.target != PaintTarget::albedo && !m.preset.empty())
    fail_usage("--material {} paints its own color, which is an albedo; leave out --target.", m.preset);
}

bool toggle_edit(Project& project, const Tools& tools, const std::string& id) {
  Stack next = project.stack();
  next.toggle(id);
  make_anew(project, tools, next);
  return project.toggle(id);
}

}  // namespace

EditSummary Session::add_edit(const char* op, Json params, EditInputs inputs, Progress& progress) {
  return threads_->run([&]() -> EditSummary {
    return add_edit_to(project(), {*device_, *frames_, progress}, op, std::move(params), std::move(inputs));
  });
}

EditSummary Session::paint(const PaintCommand& command, Progress& progress) {
  check_paint(command);
  Json strokes = Json::array();
  EditInputs inputs;
  std::string views;
  for (const PaintStroke& s : command.strokes) {
    const View& view = find_view(project().capture(), s.view);
    const std::string input =
        inputs.empty() ? "scribble.png" : fmt::format("scribble{}.png", inputs.size() + 1);
    strokes.push_back({{"view", view.name}, {"file", s.scribble.string()}, {"input", input}});
    inputs.emplace_back(input, read_file(s.scribble));
    views += (views.empty() ? "" : " ") + view.name;
  }
  Json params = {{"view", views}, {"strokes", std::move(strokes)}, {"seed", command.seed}};
  if (command.erase)
    params["erase"] = true;
  else
    params["target"] = paint_target_name(command.target);
  if (command.routing != Routing::both) params["routing"] = routing_name(command.routing);
  if (command.theta > 0) params["theta"] = command.theta;
  if (!command.set.empty()) {
    params["set"] = Json::object();
    for (const std::string& s : command.set) add_setting(branch_settings().infos(), s, params["set"]);
  }
  put_effects(command.material, params);
  return add_edit("paint", std::move(params), std::move(inputs), progress);
}

EditSummary Session::change_material(const MaterialCommand& command, Progress& progress) {
  if (command.effects.empty())
    fail_usage(
        "Nothing to change: give --material, --roughness, --roughness-scale, --specular, --metalness or "
        "--color.");
  Json params = Json::object();
  if (!command.part.empty()) params["part"] = command.part;
  put_effects(command.effects, params);
  return add_edit("material", std::move(params), {}, progress);
}

EditSummary Session::change_light(const LightChoice& choice, Progress& progress) {
  return threads_->run([&]() -> EditSummary {
    if (choice.env.empty() && choice.rotate_degrees == 0 && choice.scale == 1)
      fail_usage("Nothing to change: give --env, --rotate or --scale.");
    check_turn(choice);
    Json params = Json::object();
    EditInputs inputs;
    if (!choice.env.empty()) {
      const SgMixture light =
          environment_light(*device_, choice, project().base().up, {project().folder() / "cache", true});
      params["env"] = choice.env.string();
      inputs.emplace_back("light.npy", encode_npy(to_array(light), int64_t(light.lobes.size()), 7));
    }
    if (choice.rotate_degrees != 0) params["rotate_degrees"] = choice.rotate_degrees;
    if (choice.scale != 1) params["scale"] = choice.scale;
    return add_edit("light", std::move(params), std::move(inputs), progress);
  });
}

std::string Session::undo(Progress& progress) {
  return threads_->run([&]() -> std::string {
    Stack next = project().stack();
    next.undo();
    make_anew(project(), {*device_, *frames_, progress}, next);
    return project().undo();
  });
}

std::string Session::redo(Progress& progress) {
  return threads_->run([&]() -> std::string {
    Stack next = project().stack();
    next.redo();
    make_anew(project(), {*device_, *frames_, progress}, next);
    return project().redo();
  });
}

bool Session::toggle(const std::string& id, Progress& progress) {
  return threads_->run([&]() -> bool { return toggle_edit(project(), {*device_, *frames_, progress}, id); });
}

ReplayReport Session::replay(const std::filesystem::path& on, Progress& progress) {
  return threads_->run([&]() -> ReplayReport {
    std::error_code error;
    if (std::filesystem::equivalent(project().folder(), on, error))
      fail_usage("{} is the project itself; name another one with --on.", on.string());
    Project other = Project::open(on, Project::Mode::write);
    const Tools tools{*device_, *frames_, progress};
    const Stack& stack = project().stack();
    ReplayReport report;
    for (size_t i = 0; i < stack.cursor(); ++i) {
      const StackEntry& entry = stack.entries()[i];
      const EditRecord record = project().edit(entry.id);
      try {
        const EditOp& op = edit_op(record.op);
        const EditSummary s =
            add_edit_to(other, tools, op.name, present_params(op, record), project().edit_inputs(entry.id));
        if (record.op_version < op.version)
          report.notes.push_back(version_note(entry.id, record.op_version, op));
        if (!entry.enabled) toggle_edit(other, tools, s.id);
        report.edits.emplace_back(entry.id, s.id);
      } catch (const Error& e) {
        if (e.code() == ErrorCode::interrupted) throw;
        fail("Edit {} cannot be made on {}: {} The {} before it were.", entry.id, on.string(), e.what(), i);
      }
    }
    return report;
  });
}

}  // namespace cei3d
