// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct PaintOptions {
  std::string target = "albedo";
  PaintCommand command;
};

std::string paint_text(const PaintSummary& r) {
  std::string text = fmt::format(
      "{}: {} painted pixels on {} handler points; trace {:.2f} s, fit {:.2f} s, load and store {:.2f} s; "
      "colour error {:.4f} mean.",
      r.id, r.painted_pixels, r.points, r.trace_seconds, r.train_seconds, r.load_seconds + r.store_seconds,
      r.mean_error);
  if (r.missed_pixels > 0)
    text += fmt::format(
        " {} painted pixels are beside the object or on surface that turns away; they paint nothing.",
        r.missed_pixels);
  return text;
}

void add_paint(Commands& commands, CLI::App* edit, std::shared_ptr<std::string> project) {
  auto o = std::make_shared<PaintOptions>();
  CLI::App* verb = commands.add("paint", "Paint on the surface that one view shows", edit);
  verb->add_option("--view", o->command.view,
                   "The view painted on: train/r_055, or r_055 (then the training view)")
      ->required();
  verb->add_option("--scribble", o->command.scribble,
                   "RGBA PNG of the view's size; where alpha is at least one half, its sRGB colour becomes "
                   "the base colour")
      ->required();
  verb->add_option("--target", o->target,
                   "What the painted colour means: albedo, the base colour without light")
      ->check(CLI::IsMember({"albedo"}))
      ->capture_default_str();
  verb->add_option("--seed", o->command.seed, "Of everything random in the edit")->capture_default_str();
  commands.on(verb, o, [project](const PaintOptions& options, Session& session, Console& console) {
    if (project->empty())
      fail_usage("edit needs a PROJECT: cei3d edit PROJECT paint --view NAME --scribble FILE.png.");
    session.open(*project, Session::Access::write);
    const PaintSummary r = session.paint(options.command, console);
    console.done(r.json(), paint_text(r));
  });
}

}  // namespace

void add_edit(Commands& commands) {
  auto project = std::make_shared<std::string>();
  CLI::App* edit = commands.add("edit", "Change the object; every edit is a layer that `undo` takes back");
  // Not ->required(): CLI11 would take the operation's name for it in `cei3d edit paint -h`.
  edit->add_option("project", *project, "Project folder")->option_text("TEXT REQUIRED");
  edit->require_subcommand(1);
  add_paint(commands, edit, project);
  add_edit_shape(commands, edit, project);
}

}  // namespace cei3d
