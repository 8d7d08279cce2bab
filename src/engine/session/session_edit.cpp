// SPDX-License-Identifier: Apache-2.0
// Edits: commands become parameters and input files, from which edits are made (edit_ops.h).
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/edit/albedo_branch.h"
#include "engine/io/npy.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/session/edit_ops.h"
#include "engine/session/edit_params.h"
#include "engine/session/edit_plan.h"
#include "engine/session/light_choice.h"
#include "engine/session/session.h"
#include "engine/session/stopwatch.h"

namespace cei3d {
namespace {

// The context of edits.
struct Tools {
  const Device& device;
  RenderCache& frames;
  SamMemory& sam;
  Progress& progress;
  EditContext on(const Capture& capture, const Scene& below) const {
    return {device, capture, below, frames, sam, progress};
  }
};

// Usage error: the last edit that is done is not one of this kind and on the same part.
void require_amendable(const Project& project, const EditPlan& plan) {
  const Stack& stack = project.stack();
  const std::string last = stack.cursor() == 0 ? "" : stack.entries()[stack.cursor() - 1].id;
  const bool fits = !last.empty() && stack.entries()[stack.cursor() - 1].enabled;
  const EditRecord record = fits ? project.edit(last) : EditRecord();
  if (record.op != plan.op || record.params.value("part", "") != plan.params.value("part", ""))
    fail_usage("The last edit is no '{}' of the same part: there is nothing to amend.", plan.op);
}

EditPreview made_of(const Project& project, const Tools& tools, EditPlan plan, bool amend) {
  Stopwatch watch;
  const EditOp& op = edit_op(plan.op);
  EditPreview p;
  p.stack = project.stack();
  p.place = amend ? Project::Place::instead_of_last : Project::Place::on_top;
  if (amend) require_amendable(project, plan);
  p.below =
      amend ? project.scene_below(p.stack, p.stack.entries()[p.stack.cursor() - 1].id) : project.scene();
  p.load_seconds = watch.lap();
  const EditJob job{p.stack.next_id(plan.op), std::move(plan.params), std::move(plan.inputs)};
  EditOutcome made = op.make(tools.on(project.capture(), p.below), job);
  const double seconds = watch.lap();
  if (!made.report.contains("seconds")) made.report["seconds"] = {{plan.op, seconds}};
  p.record = {job.id, plan.op, op.version, job.params, op.depends(job.params), made.report, job.inputs};
  p.layer = std::move(made.layer);
  return p;
}

EditSummary store(Project& project, const EditPreview& p) {
  if (!(project.stack() == p.stack))
    fail("The history has changed since this edit was prepared; make it again.");
  Stopwatch watch;
  project.add_edit(p.record, p.layer, p.place);
  return {p.record.id, p.record.report, p.load_seconds, watch.lap()};
}

EditSummary add_edit_to(Project& project, const Tools& tools, EditPlan plan, bool amend = false) {
  return store(project, made_of(project, tools, std::move(plan), amend));
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
      const EditOutcome made =
          op.make(tools.on(project.capture(), below), {*id, params, project.edit_inputs(*id)});
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
  if (!(c.theta >= 0 && std::isfinite(c.theta))) fail_usage("Theta, {}, is not a distance.", c.theta);
  if (c.theta > 0 && c.routing != Routing::points) fail_usage("Theta goes with routing by points.");
  if (c.erase && c.target != PaintTarget::albedo) fail_usage("The eraser paints no color; it has no target.");
  if (c.erase && c.routing == Routing::none) fail_usage("The eraser needs a region; use another routing.");
  if (!m.color.empty()) fail_usage("Paint has the colors of its scribble; leave out the color.");
  if (m.blend) fail_usage("Paint is blended by the scribble's alpha; leave out the blend.");
  if (m.empty()) return;
  if (c.erase) fail_usage("The eraser restores the material; leave out the new one.");
  if (c.routing == Routing::none) fail_usage("A material needs a region; use another routing.");
  if (c.target == PaintTarget::radiance)
    fail_usage("Color that is shown under every light (target radiance) has no material; leave it out.");
  if (c.target != PaintTarget::albedo && !m.preset.empty())
    fail_usage("Material {} paints its own color, which is an albedo; leave out the target.", m.preset);
}

// Undo or redo: a function of the stack, and that of the project which stores what it does.
std::string move_cursor(Project& project, const Tools& tools, std::string (Stack::*move)(),
                        std::string (Project::*store)()) {
  Stack next = project.stack();
  (next.*move)();
  make_anew(project, tools, next);
  return (project.*store)();
}

bool toggle_edit(Project& project, const Tools& tools, const std::string& id) {
  Stack next = project.stack();
  next.toggle(id);
  make_anew(project, tools, next);
  return project.toggle(id);
}

}  // namespace

EditSummary Session::edit(const EditCommand& command, Progress& progress, bool amend) {
  return threads_->run([&]() -> EditSummary {
    const auto make_plan = [&](const auto& c) { return plan(c); };
    return add_edit_to(project(), {*device_, *frames_, *sam_, progress}, std::visit(make_plan, command),
                       amend);
  });
}

std::shared_ptr<const EditPreview> Session::preview(const EditCommand& command, Progress& progress,
                                                    bool amend) {
  return threads_->run([&]() -> std::shared_ptr<const EditPreview> {
    const auto make_plan = [&](const auto& c) { return plan(c); };
    EditPlan edit = std::visit(make_plan, command);
    return std::make_shared<const EditPreview>(
        made_of(project(), {*device_, *frames_, *sam_, progress}, std::move(edit), amend));
  });
}

EditSummary Session::commit(const EditPreview& preview) {
  return threads_->run([&]() -> EditSummary { return store(project(), preview); });
}

EditSummary Session::paint(const PaintCommand& c, Progress& p) { return edit(c, p); }
EditSummary Session::change_material(const MaterialCommand& c, Progress& p) { return edit(c, p); }
EditSummary Session::change_light(const LightChoice& c, Progress& p) { return edit(c, p); }
EditSummary Session::deform(const DeformCommand& c, Progress& p) { return edit(c, p); }
EditSummary Session::remove(const RemoveCommand& c, Progress& p) { return edit(c, p); }
EditSummary Session::select_part(const PartCommand& c, Progress& p) { return edit(c, p); }

EditPlan Session::plan(const PaintCommand& command) const {
  check_paint(command);
  Json strokes = Json::array();
  EditInputs inputs;
  std::string views;
  for (const PaintStroke& given : command.strokes) {
    const PaintStroke s = given.decal ? laid_decal(given) : given;
    const std::string input =
        inputs.empty() ? "scribble.png" : fmt::format("scribble{}.png", inputs.size() + 1);
    strokes.push_back(Json::object());
    put_place(project().capture(), s.view, s.camera, strokes.back());
    if (!s.scribble.path.empty()) strokes.back()["file"] = s.scribble.path.string();
    strokes.back()["input"] = input;
    inputs.emplace_back(input, s.scribble.read());
    const std::string view = strokes.back().value("view", "");
    views += (views.empty() || view.empty() ? "" : " ") + view;
  }
  Json params = Json::object();
  if (!views.empty()) params["view"] = views;
  params["strokes"] = std::move(strokes);
  params["seed"] = command.seed;
  if (command.erase)
    params["erase"] = true;
  else
    params["target"] = paint_target_name(command.target);
  if (command.routing != Routing::both) params["routing"] = routing_name(command.routing);
  if (command.theta > 0) params["theta"] = command.theta;
  put_settings(branch_settings().infos(), command.set, params);
  put_effects(command.material, params);
  return {"paint", std::move(params), std::move(inputs)};
}

EditPlan Session::plan(const MaterialCommand& command) const {
  if (command.effects.empty())
    fail_usage(
        "Nothing to change: give a material, a roughness or roughness scale, a specular strength, a "
        "metalness "
        "or a color.");
  Json params = Json::object();
  if (!command.part.empty()) params["part"] = command.part;
  put_effects(command.effects, params);
  return {"material", std::move(params), {}};
}

EditPlan Session::plan(const LightChoice& choice) const {
  if (choice.is_own()) fail_usage("Nothing to change: give an environment, a rotation, a scale or a sun.");
  check_choice(choice);
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
  if (choice.sun) {
    const Vec3d d = choice.sun->direction;
    params["sun"] = {{"direction", {d.x, d.y, d.z}}, {"strength", choice.sun->strength}};
  }
  return {"light", std::move(params), std::move(inputs)};
}

std::string Session::undo(Progress& progress) {
  return threads_->run([&] {
    return move_cursor(project(), {*device_, *frames_, *sam_, progress}, &Stack::undo, &Project::undo);
  });
}

std::string Session::redo(Progress& progress) {
  return threads_->run([&] {
    return move_cursor(project(), {*device_, *frames_, *sam_, progress}, &Stack::redo, &Project::redo);
  });
}

void Session::move_to(const Stack& next, Json event, Progress& progress) {
  threads_->run([&] {
    make_anew(project(), {*device_, *frames_, *sam_, progress}, next);
    project().move_to(next, std::move(event));
  });
}

void Session::go_to(size_t done, Progress& progress) {
  Stack next = project().stack();
  next.go_to(done);
  move_to(next, {{"do", "goto"}, {"done", done}}, progress);
}

void Session::rename(const std::string& id, const std::string& name) {
  Stack next = project().stack();
  next.rename(id, name);
  project().move_to(next, {{"do", "rename"}, {"id", id}, {"name", name}});
}

void Session::restore(const std::string& id, Progress& progress) {
  Stack next = project().stack();
  next.restore(id);
  move_to(next, {{"do", "restore"}, {"id", id}}, progress);
}

void Session::forget_set_aside() { project().forget_set_aside(); }

bool Session::toggle(const std::string& id, Progress& progress) {
  return threads_->run([&]() -> bool {
    return toggle_edit(project(), {*device_, *frames_, *sam_, progress}, id);
  });
}

EditSummary Session::edit_by_params(const std::string& op, const Json& params, Progress& progress) {
  return threads_->run([&]() -> EditSummary {
    return add_edit_to(project(), {*device_, *frames_, *sam_, progress}, {edit_op(op).name, params, {}});
  });
}

ReplayReport Session::replay(const std::filesystem::path& on, Progress& progress) {
  return threads_->run([&]() -> ReplayReport {
    std::error_code error;
    if (std::filesystem::equivalent(project().folder(), on, error))
      fail_usage("{} is the project itself; name another one to make the edits on.", on.string());
    Project other = Project::open(on, Project::Mode::write);
    const Tools tools{*device_, *frames_, *sam_, progress};
    const Stack& stack = project().stack();
    ReplayReport report;
    for (size_t i = 0; i < stack.cursor(); ++i) {
      const StackEntry& entry = stack.entries()[i];
      const EditRecord record = project().edit(entry.id);
      try {
        const EditOp& op = edit_op(record.op);
        const EditSummary s =
            add_edit_to(other, tools, {op.name, present_params(op, record), project().edit_inputs(entry.id)});
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
