// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"

namespace cei3d {
namespace {

struct Options {
  std::string target = "albedo", routing = "both";
  std::vector<std::string> views, scribbles;
  PaintCommand command;
  EditOutput output;
};

PaintCommand command_of(const Options& o) {
  if (o.views.size() != o.scribbles.size())
    fail_usage("There are {} --view and {} --scribble: each scribble needs the view it was painted on.",
               o.views.size(), o.scribbles.size());
  PaintCommand c = o.command;
  c.target = *paint_target_from_name(o.target);
  c.routing = *routing_from_name(o.routing);
  for (size_t i = 0; i < o.views.size(); ++i) c.strokes.push_back({o.views[i], o.scribbles[i]});
  return c;
}

std::string text_of(const EditSummary& s) {
  const auto count = [&](const char* key) { return s.report.at(key).get<size_t>(); };
  std::string text = fmt::format("{}: {} painted pixels on {} handler points; {}; color error {:.4f} mean.",
                                 s.id, count("painted_pixels"), count("points"), stages_text(s),
                                 s.report.at("mean_error").get<double>());
  if (count("missed_pixels") > 0)
    text += fmt::format(
        " {} painted pixels are beside the object or on surface that turns away; they paint nothing.",
        count("missed_pixels"));
  if (const double share = s.report.at("out_of_reach").get<double>(); share > 0.005)
    text += fmt::format(
        " {:.0f} % of the paint is brighter or darker than any base color there looks in this light.",
        100 * share);
  return text;
}

}  // namespace

void add_edit_paint(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("paint", "Paint on the surface that one view shows", edit);
  verb->add_option(
          "--view", o->views,
          "The view painted on: train/r_055, or r_055 (then the training view). --view and --scribble may be "
          "given several times, in pairs: one edit, and a later scribble covers an earlier one")
      ->required()
      ->expected(1)
      ->take_all();
  verb->add_option("--scribble", o->scribbles,
                   "RGBA PNG of the view's size. Where it is opaque, its sRGB color becomes the base "
                   "color; where it is "
                   "semi-transparent, it covers what is there by as much as its alpha says")
      ->required()
      ->expected(1)
      ->take_all();
  CLI::Option* target =
      verb->add_option("--target", o->target,
                       "What the painted color means: albedo, the base color without light; "
                       "appearance, what the view shows in the light there is now; radiance, what "
                       "shows in every light, as if it shone")
          ->check(CLI::IsMember({"albedo", "appearance", "radiance"}))
          ->capture_default_str();
  verb->add_flag("--erase", o->command.erase,
                 "Show the reconstructed colors again where the scribble is opaque")
      ->excludes(target);
  verb->add_option(
          "--routing", o->routing,
          "What tells painted surface from the rest: both, handler points and the scribble's outline; points "
          "or "
          "outline, one of them; none, the object's one color field learns the scribble, for comparison: it "
          "spills")
      ->check(CLI::IsMember({"both", "points", "outline", "none"}))
      ->capture_default_str();
  verb->add_option("--seed", o->command.seed, "Of everything random in the edit")->capture_default_str();
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    const PaintCommand command = command_of(options);
    open_for_edit(session, *project, "paint --view NAME --scribble FILE.png");
    const EditSummary s = session.paint(command, console);
    finish_edit(session, console, s, text_of(s), options.output);
  });
}

}  // namespace cei3d
