// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct Options {
  PartCommand command;
  std::vector<std::string> positive, negative;
  std::string mask, like, camera;
  std::string views = "10", on = "renders", order = "informative", combine = "votes";
  bool keep_texture = false, remove = false;
  EditSettings settings;
  EditOutput output;
};

int parse_views(const std::string& text) {
  if (text == "all") return ViewPlan::kAll;
  const double n = parse_numbers(text, 1, "--views")[0];
  if (!(n >= 1 && n <= 1e6 && n == std::floor(n)))
    fail_usage("--views '{}' is neither a number of views nor `all`.", text);
  return int(n);
}

PartCommand command_of(const Options& o) {
  PartCommand c = o.command;
  c.positive = parse_pixels(o.positive, "--positive");
  c.negative = parse_pixels(o.negative, "--negative");
  if (c.view.empty() == o.camera.empty()) fail_usage("Give --view NAME or --camera FILE.json.");
  if (!o.camera.empty()) c.camera = read_camera(o.camera);
  if (!o.mask.empty()) c.mask = std::filesystem::path(o.mask);
  if (!o.like.empty()) c.like = parse_pixels({o.like}, "--like").front();
  c.effects.replace = !c.effects.color.empty() && !o.keep_texture;
  c.keep_texture = c.effects.color.empty() && o.keep_texture;
  c.set = o.settings.set;
  c.network.photographs = o.on == "photographs";
  c.network.plan = {parse_views(o.views), *view_order_from_name(o.order),
                    *mask_combination_from_name(o.combine)};
  return c;
}

std::string text_of(const EditSummary& s) {
  return fmt::format("{}: part {}, {} handler points, {:.1f} % of the surface; {}.", s.id,
                     s.report.at("part").get<std::string>(), s.report.at("points").get<size_t>(),
                     100 * s.report.at("share").get<double>(), stages_text(s));
}

// Clicks and strokes.
std::vector<CLI::Option*> add_prompts(CLI::App* verb, Options& o) {
  PartCommand& c = o.command;
  std::vector<CLI::Option*> prompts;
  const auto prompt = [&](CLI::Option* option) {
    prompts.push_back(option);
    return option;
  };
  prompt(verb->add_option("--positive", o.positive,
                          "Clicks on the part, X,Y ... (column, row from the top left corner)"));
  prompt(verb->add_option("--negative", o.negative, "Clicks that are not on the part, X,Y ..."));
  CLI::Option* scribble = prompt(
      verb->add_option("--scribble", c.scribble,
                       "RGBA PNG of the view's size whose opaque pixels are strokes on the part, alone or "
                       "besides clicks. The part gets the color of the strokes, or, if they have several, "
                       "the pattern of the largest rectangle that they fill, repeated")
          ->check(CLI::ExistingFile));
  prompt(verb->add_option("--negative-scribble", c.negative_scribble,
                          "RGBA PNG whose opaque pixels are strokes that are not on the part")
             ->needs(scribble)
             ->check(CLI::ExistingFile));
  prompt(verb->add_option("--negative-color", c.negative_color,
                          "'#RRGGBB', sRGB: strokes of the --scribble in this color are not on the part")
             ->needs(scribble));
  verb->add_flag("--keep-color", c.keep_color, "With --scribble: do not give the part its color")
      ->needs(scribble);
  return prompts;
}

void add_network(CLI::App* verb, Options& o) {
  verb->add_option("--segmenter", o.command.segmenter,
                   "How the part is found. grow: in 3D by color and creases, about a second. sam: in images "
                   "by a network that `./run sam` installs")
      ->check(CLI::IsMember({"grow", "sam"}))
      ->capture_default_str();
  verb->add_option("--on", o.on,
                   "Images for the network. renders: of the albedo, without shadows and highlights. "
                   "photographs: of the training views")
      ->check(CLI::IsMember({"renders", "photographs"}))
      ->capture_default_str();
  verb->add_option("--views", o.views, "Maximum number of views for the network, or `all`")
      ->capture_default_str();
  verb->add_option("--order", o.order,
                   "Next view for the network. informative: the one that adds most, until none adds "
                   "anything. adjacent: the one nearest to the last")
      ->check(CLI::IsMember({"informative", "adjacent"}))
      ->capture_default_str();
  verb->add_option("--combine", o.combine,
                   "How the network's masks become a part. votes: the views vote, and masks that contradict "
                   "the others do not count. any: what any mask shows")
      ->check(CLI::IsMember({"votes", "any"}))
      ->capture_default_str();
}

void add_where(CLI::App* verb, Options& o) {
  PartCommand& c = o.command;
  verb->add_option("--view", c.view, "View of the clicks, strokes or mask, for example train/r_055");
  verb->add_option("--camera", o.camera, "Instead of --view: " + std::string(kCameraHelp));
  CLI::Option* mask =
      verb->add_option(
              "--mask", o.mask,
              "Instead of clicks: a PNG of the view's size that shows the whole part, opaque, or bright "
              "if it is opaque everywhere")
          ->check(CLI::ExistingFile);
  CLI::Option* like =
      verb->add_option("--like", o.like,
                       "Instead of clicks: X,Y of a pixel; selects all surface with the material seen there "
                       "(roughness within 0.1, metalness within 0.25), wherever it is")
          ->excludes(mask);
  for (CLI::Option* prompt : add_prompts(verb, o)) {
    mask->excludes(prompt);
    like->excludes(prompt);
  }
  verb->add_flag("--like-color", c.like_color, "With --like: and with a similar color")->needs(like);
  add_network(verb, o);
}

void add_name(CLI::App* verb, PartCommand& c) {
  verb->add_flag("--in-view", c.in_view,
                 "Select only what this view shows of the part; do not propagate to other views");
  verb->add_option(
      "--name", c.name,
      "Name of the part (default: part1, part2, ..., or the name given to --add, --subtract or --intersect)");
  CLI::Option* add = verb->add_option("--add", c.add, "Add the selection to this part");
  CLI::Option* subtract =
      verb->add_option("--subtract", c.subtract, "Subtract the selection from this part")->excludes(add);
  verb->add_option("--intersect", c.intersect, "Intersect the selection with this part")
      ->excludes(add)
      ->excludes(subtract);
}

void add_part_effects(CLI::App* verb, Options& o) {
  MaterialEffects& e = o.command.effects;
  CLI::Option* color = verb->add_option("--color", e.color, "'#RRGGBB', sRGB: new albedo of the part");
  verb->add_flag("--keep-texture", o.keep_texture,
                 "With --color or --scribble: scale the texture so that its mean is the color, instead of "
                 "replacing it");
  add_material_values(verb, e);
  add_blend(verb, e);
  verb->add_flag("--remove", o.remove,
                 "Also remove the part and close the surface behind it, as a second edit")
      ->excludes(color);
}

}  // namespace

void add_edit_part(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("part",
                                "Select a part by clicks, strokes or its material in one view; name it, "
                                "recolor it, change its material",
                                edit);
  add_where(verb, *o);
  add_name(verb, o->command);
  add_part_effects(verb, *o);
  add_settings(verb, o->settings);
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    if (options.settings.list) return list_settings(console, "part");
    const PartCommand command = command_of(options);
    open_for_edit(session, *project, "part --view NAME --positive X,Y");
    const EditSummary s = session.select_part(command, console);
    if (!options.remove) return finish_edit(session, console, s, text_of(s), options.output);
    const EditSummary removed = session.remove({s.report.at("part").get<std::string>()}, console);
    finish_edit(session, console, removed, text_of(s) + "\n" + remove_text(removed), options.output);
  });
}

}  // namespace cei3d
