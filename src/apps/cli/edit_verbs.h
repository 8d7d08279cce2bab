// SPDX-License-Identifier: Apache-2.0
// What the commands of `edit` have in common.
#pragma once

#include "apps/cli/command.h"
#include "core/base/error.h"

namespace cei3d {

using ProjectName = std::shared_ptr<std::string>;  // filled when the command line is parsed

// Usage error without a project. example: "paint --view NAME --scribble FILE.png".
void open_for_edit(Session&, const std::string& project, const char* example);

// "trace 0.10 s, fit 0.42 s, load and store 0.08 s"
std::string stages_text(const EditSummary&);

std::string remove_text(const EditSummary&);

// Help of --camera.
inline constexpr const char* kCameraHelp =
    "a camera of its own, FILE.json as a render.json with one camera; the scribble or mask has its size";

// --picture, an option of every edit.
struct EditOutput {
  std::string picture;
};
void add_output(CLI::App* verb, EditOutput&);
// Prints the report of an edit and writes its --picture.
void finish_edit(Session&, Console&, const EditSummary&, std::string text, const EditOutput&);

// --set, --list-settings
struct EditSettings {
  std::vector<std::string> set;
  bool list = false;
};
void add_settings(CLI::App* verb, EditSettings&);
// edit: "paint".
void list_settings(Console&, const std::string& edit);

void add_amend(CLI::App* verb, bool& amend);  // --amend

// --material, --roughness, --roughness-scale, --specular, --metalness
void add_material_values(CLI::App* verb, MaterialEffects&);
void add_blend(CLI::App* verb, MaterialEffects&);
// The options of add_material_values() and add_blend(), and --color, --replace.
void add_effects(CLI::App* verb, MaterialEffects&);

void add_edit_paint(Commands&, CLI::App* edit, ProjectName);
void add_edit_material(Commands&, CLI::App* edit, ProjectName);
void add_edit_light(Commands&, CLI::App* edit, ProjectName);
void add_edit_part(Commands&, CLI::App* edit, ProjectName);
void add_edit_shape(Commands&, CLI::App* edit, ProjectName);  // deform, remove

}  // namespace cei3d
