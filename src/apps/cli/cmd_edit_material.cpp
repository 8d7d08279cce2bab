// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"

namespace cei3d {
namespace {

struct Options {
  MaterialCommand command;
  bool amend = false;
  EditOutput output;
};

}  // namespace

void add_material_values(CLI::App* verb, MaterialEffects& e) {
  verb->add_option("--material", e.preset,
                   "A material by name, with its color; the options below replace its values. Names: " +
                       material_preset_names())
      ->check(CLI::Validator(unknown_preset, "NAME"));
  CLI::Option* roughness =
      verb->add_option("--roughness", e.roughness, "0 (mirror) to 1; the square root of GGX alpha");
  verb->add_option("--roughness-scale", e.roughness_scale,
                   "Multiply the present roughness by this factor instead; the result is clamped to 1")
      ->excludes(roughness);
  verb->add_option(
      "--specular", e.specular,
      "Strength of the reflection of dielectrics, 0 to 1; 0.5, typical, reflects 4 % along the normal");
  verb->add_option("--metalness", e.metalness, "0 (dielectric) to 1 (metal)");
}

void add_blend(CLI::App* verb, MaterialEffects& e) {
  verb->add_option("--blend", e.blend,
                   "Share of the new material and color, 0 to 1; the rest is the present value (default: 1)");
}

void add_effects(CLI::App* verb, MaterialEffects& e) {
  add_material_values(verb, e);
  add_blend(verb, e);
  CLI::Option* color = verb->add_option(
      "--color", e.color,
      "'#RRGGBB', sRGB: new mean albedo; the present texture is scaled to it. With --material: instead of "
      "the material's color, which replaces the texture");
  verb->add_flag("--replace", e.replace, "Replace the texture by --color")->needs(color);
}

void add_edit_material(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(
      "material", "Replace, scale or blend the material or color of the object or of a part", edit);
  verb->add_option("--part", o->command.part,
                   "Name of a part, made by `edit part` (default: the whole object)");
  add_effects(verb, o->command.effects);
  add_amend(verb, o->amend);
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    open_for_edit(session, *project, "material --roughness R");
    const EditSummary s = session.edit(options.command, console, options.amend);
    const std::string& part = options.command.part;
    const std::string text = fmt::format("{}: {}, {} points of the surface; {}.", s.id,
                                         part.empty() ? "the whole object" : "part " + part,
                                         s.report.at("points").get<size_t>(), stages_text(s));
    finish_edit(session, console, s, text, options.output);
  });
}

}  // namespace cei3d
