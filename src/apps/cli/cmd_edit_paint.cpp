// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"

namespace cei3d {
namespace {

struct Options {
  std::string target = "albedo";
  PaintCommand command;
};

std::string text_of(const EditSummary& s) {
  const auto count = [&](const char* key) { return s.report.at(key).get<size_t>(); };
  std::string text = fmt::format("{}: {} painted pixels on {} handler points; {}; colour error {:.4f} mean.",
                                 s.id, count("painted_pixels"), count("points"), stages_text(s),
                                 s.report.at("mean_error").get<double>());
  if (count("missed_pixels") > 0)
    text += fmt::format(
        " {} painted pixels are beside the object or on surface that turns away; they paint nothing.",
        count("missed_pixels"));
  return text;
}

}  // namespace

void add_edit_paint(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("paint", "Paint on the surface that one view shows", edit);
  verb->add_option("--view", o->command.view,
                   "The view painted on: train/r_055, or r_055 (then the training view)")
      ->required();
  verb->add_option(
          "--scribble", o->command.scribble,
          "RGBA PNG of the view's size; where alpha is at least one half, its sRGB colour becomes the base "
          "colour")
      ->required();
  verb->add_option("--target", o->target,
                   "What the painted colour means: albedo, the base colour without light")
      ->check(CLI::IsMember({"albedo"}))
      ->capture_default_str();
  verb->add_option("--seed", o->command.seed, "Of everything random in the edit")->capture_default_str();
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    open_for_edit(session, *project, "paint --view NAME --scribble FILE.png");
    const EditSummary s = session.paint(options.command, console);
    console.done(s.json(), text_of(s));
  });
}

}  // namespace cei3d
