// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"
#include "core/base/json.h"

namespace cei3d {

void open_for_edit(Session& session, const std::string& project, const char* example) {
  if (project.empty()) fail_usage("edit needs a PROJECT, for example: cei3d edit PROJECT {}.", example);
  session.open(project, Session::Access::write);
}

std::string stages_text(const EditSummary& s) {
  std::string text;
  for (const auto& [stage, seconds] : s.report.at("seconds").items())
    text += fmt::format("{} {:.2f} s, ", stage, seconds.get<double>());
  return text + fmt::format("load and store {:.2f} s", s.load_seconds + s.store_seconds);
}

void add_output(CLI::App* verb, EditOutput& o) {
  const auto ends_in_png = [](const std::string& file) {
    return file.ends_with(".png") ? std::string()
                                  : file + ": the image is written as PNG; give a name that ends in .png";
  };
  verb->add_option("--picture", o.picture,
                   "PNG file to write: before and after side by side, in the edited view or else the first "
                   "held-out view. Also reports the number of changed pixels")
      ->check(CLI::Validator(ends_in_png, "PNG"));
}

void add_settings(CLI::App* verb, EditSettings& s) {
  verb->add_option(
          "--set", s.set,
          "key=value: a number or choice of how the edit is made; repeatable. @FILE.json: a file that "
          "holds {\"set\": {\"key\": value, ...}}")
      ->expected(1)
      ->take_all();
  verb->add_flag("--list-settings", s.list, "List what --set can change, and do nothing else");
}

void list_settings(Console& console, const std::string& edit) {
  const SettingsReport r = settings_of_edit(edit);
  console.answer(r.json(), r.text());
}

void add_amend(CLI::App* verb, bool& amend) {
  verb->add_flag("--amend", amend,
                 "In place of the last edit, which must be of the same kind and on the same part");
}

void finish_edit(Session& session, Console& console, const EditSummary& s, std::string text,
                 const EditOutput& o) {
  Json json = s.json();
  if (!o.picture.empty()) {
    const ChangeSummary c = session.show_change({s.id, "", o.picture});
    json["change"] = c.json();
    text += fmt::format(" In view {}: {} pixels inside, {} changed outside; see {}.", c.view, c.pixels_inside,
                        c.changed_outside, o.picture);
  }
  console.done(json, text);
}

void add_edit(Commands& commands) {
  auto project = std::make_shared<std::string>();
  CLI::App* edit = commands.add("edit", "Change the object; every edit is a layer that `undo` removes");
  // Not ->required(): CLI11 would take the operation's name for it in `cei3d edit paint -h`.
  edit->add_option("project", *project, "Project folder")->option_text("TEXT REQUIRED");
  edit->require_subcommand(1);
  add_edit_paint(commands, edit, project);
  add_edit_part(commands, edit, project);
  add_edit_material(commands, edit, project);
  add_edit_light(commands, edit, project);
  add_edit_shape(commands, edit, project);
}

}  // namespace cei3d
