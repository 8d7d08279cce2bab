// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct Options {
  PartCommand command;
  std::vector<std::string> positive, negative;
  bool replace = true, remove = false;
  EditOutput output;
};

PartCommand command_of(const Options& o) {
  PartCommand c = o.command;
  c.positive = parse_pixels(o.positive, "--positive");
  c.negative = parse_pixels(o.negative, "--negative");
  c.effects.replace = !c.effects.color.empty() && o.replace;
  return c;
}

std::string text_of(const EditSummary& s) {
  return fmt::format("{}: part {}, {} handler points, {:.1f} % of the surface; {}.", s.id,
                     s.report.at("part").get<std::string>(), s.report.at("points").get<size_t>(),
                     100 * s.report.at("share").get<double>(), stages_text(s));
}

void add_where(CLI::App* verb, Options& o) {
  PartCommand& c = o.command;
  verb->add_option("--view", c.view, "The view clicked in: train/r_055, or r_055 (then the training view)")
      ->required();
  CLI::Option* positive = verb->add_option(
      "--positive", o.positive, "Clicks on the part, X,Y (column, row from the top left corner) ...");
  CLI::Option* negative =
      verb->add_option("--negative", o.negative, "Clicks beside it, where it goes too far ...");
  verb->add_option(
          "--mask", c.mask,
          "In place of clicks a PNG of the view's size: the part is where it is opaque, or bright if it is "
          "opaque everywhere")
      ->excludes(positive)
      ->excludes(negative)
      ->check(CLI::ExistingFile);
  verb->add_option(
          "--segmenter", c.segmenter,
          "How the part is found: grow, in 3D by color and creases, in a second; sam, in pictures by a "
          "network that `./run sam` installs")
      ->check(CLI::IsMember({"grow", "sam"}))
      ->capture_default_str();
}

void add_name(CLI::App* verb, PartCommand& c) {
  verb->add_flag("--in-view", c.in_view,
                 "Only what this view shows of the part, not carried on to what other views show of it");
  verb->add_option("--name", c.name,
                   "Name of the part (default: part1, part2, ... or that of the part combined with)");
  CLI::Option* add = verb->add_option("--add", c.add, "What was clicked is added to the part of this name");
  CLI::Option* subtract = verb->add_option("--subtract", c.subtract, "... is taken off it")->excludes(add);
  verb->add_option("--intersect", c.intersect, "Only what is in both")->excludes(add)->excludes(subtract);
}

void add_part_effects(CLI::App* verb, Options& o) {
  MaterialEffects& e = o.command.effects;
  CLI::Option* color =
      verb->add_option("--color", e.color, "'#RRGGBB', sRGB: the part's base color from now on");
  verb->add_flag("--replace,!--keep-texture", o.replace,
                 "The color replaces the texture; or it is that on average, and the texture scaled to it "
                 "[--replace]")
      ->needs(color);
  add_material_values(verb, e);
  verb->add_flag(
          "--remove", o.remove,
          "The part is taken off and the surface behind it closed: a second edit, as `edit remove` makes it")
      ->excludes(color);
}

}  // namespace

void add_edit_part(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb =
      commands.add("part", "Select a part by clicks in one view; name, color or change it", edit);
  add_where(verb, *o);
  add_name(verb, o->command);
  add_part_effects(verb, *o);
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    const PartCommand command = command_of(options);
    open_for_edit(session, *project, "part --view NAME --positive X,Y");
    const EditSummary s = session.select_part(command, console);
    if (!options.remove) return finish_edit(session, console, s, text_of(s), options.output);
    const EditSummary removed = session.remove({s.report.at("part").get<std::string>()}, console);
    finish_edit(session, console, removed, text_of(s) + "\n" + remove_text(removed), options.output);
  });
}

}  // namespace cei3d
