// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct Options {
  std::string target = "albedo", routing = "both";
  std::vector<std::string> views, cameras, scribbles;
  std::string decal, at;
  DecalPlace place;
  PaintCommand command;
  EditSettings settings;
  EditOutput output;
};

// The picture that is laid onto the surface, in place of scribbles.
PaintStroke decal_of(const Options& o) {
  if (o.views.size() + o.cameras.size() != 1 || o.at.empty() || o.place.width == 0)
    fail_usage("--decal needs one --view or --camera, --at X,Y and --width W.");
  const std::vector<double> at = parse_numbers(o.at, 2, "--at");
  PaintStroke s;
  if (o.cameras.empty())
    s.view = o.views.front();
  else
    s.camera = read_camera(o.cameras.front());
  s.scribble = std::filesystem::path(o.decal);
  s.decal = o.place;
  s.decal->pixel = {at[0], at[1]};
  return s;
}

PaintCommand command_of(const Options& o) {
  const size_t places = o.views.size() + o.cameras.size();
  if (!o.views.empty() && !o.cameras.empty()) fail_usage("Give --view or --camera, not both.");
  if (o.scribbles.empty() == o.decal.empty()) fail_usage("Give --scribble FILE.png or --decal FILE.");
  PaintCommand c = o.command;
  c.target = *paint_target_from_name(o.target);
  c.routing = *routing_from_name(o.routing);
  c.set = o.settings.set;
  if (!o.decal.empty()) {
    c.strokes.push_back(decal_of(o));
    return c;
  }
  if (places != o.scribbles.size())
    fail_usage("There are {} --view or --camera and {} --scribble options; give one for each scribble.",
               places, o.scribbles.size());
  for (size_t i = 0; i < o.scribbles.size(); ++i) {
    PaintStroke s;
    if (o.cameras.empty())
      s.view = o.views[i];
    else
      s.camera = read_camera(o.cameras[i]);
    s.scribble = std::filesystem::path(o.scribbles[i]);
    c.strokes.push_back(std::move(s));
  }
  return c;
}

std::string text_of(const EditSummary& s) {
  const auto count = [&](const char* key) { return s.report.at(key).get<size_t>(); };
  std::string text =
      fmt::format("{}: {} painted pixels on {} handler points ({} new); {}; mean color error {:.4f}.", s.id,
                  count("painted_pixels"), count("points"), count("refined"), stages_text(s),
                  s.report.at("mean_error").get<double>());
  if (count("missed_pixels") > 0)
    text += fmt::format(
        " {} painted pixels have no effect: they are beside the object or on a surface that faces away.",
        count("missed_pixels"));
  if (count("unchanged_pixels") > 0)
    text +=
        fmt::format(" {} pixels have the surface's own color and change nothing.", count("unchanged_pixels"));
  if (const double share = s.report.at("out_of_reach").get<double>(); share > 0.005)
    text +=
        fmt::format(" {:.0f} % of the paint is brighter or darker than any albedo can appear in this light.",
                    100 * share);
  return text;
}

// Where the paint comes from: scribbles on views, or a decal.
void add_pictures(CLI::App* verb, Options& o) {
  verb->add_option("--view", o.views,
                   "View that was painted on, for example train/r_055. --view and --scribble may be given "
                   "several times, in pairs; later scribbles cover earlier ones")
      ->expected(1)
      ->take_all();
  verb->add_option("--camera", o.cameras, "Instead of --view: " + std::string(kCameraHelp))
      ->expected(1)
      ->take_all();
  verb->add_option(
          "--scribble", o.scribbles,
          "RGBA PNG of the view's size. Where it is opaque, its sRGB color becomes the albedo; "
          "semi-transparent strokes are blended by their alpha. A material is painted where alpha is above "
          "one half; --material paints with its own color instead of the scribble's")
      ->expected(1)
      ->take_all();
  CLI::Option* decal = verb->add_option(
      "--decal", o.decal,
      "Instead of --scribble: a picture, PNG or JPEG, that is laid onto the surface at --at, upright in the "
      "view, seen along the surface's normal there");
  verb->add_option("--at", o.at, "Pixel of the view where the decal's middle is, X,Y")->needs(decal);
  verb->add_option("--width", o.place.width, "Width of the decal, capture units")->needs(decal);
  verb->add_option("--turn", o.place.turn_degrees, "Turn the decal clockwise in the view, degrees")
      ->needs(decal);
}

// What the paint means, and which surface it covers.
void add_meaning(CLI::App* verb, Options& o) {
  CLI::Option* target =
      verb->add_option("--target", o.target,
                       "Meaning of the painted color. albedo: color without light. appearance: color that "
                       "the view shows under the present light. radiance: color shown under every light")
          ->check(CLI::IsMember({"albedo", "appearance", "radiance"}))
          ->capture_default_str();
  verb->add_flag("--erase", o.command.erase,
                 "Restore the reconstructed albedo and material where the scribble is opaque")
      ->excludes(target);
  verb->add_option(
          "--routing", o.routing,
          "How painted surface is found. both: near edited handler points and inside the scribble's outline. "
          "points: where the nearest handler point is edited. outline: without handler points. none: retrain "
          "the object's albedo field instead, which changes other places, too; for comparison")
      ->check(CLI::IsMember({"both", "points", "outline", "none"}))
      ->capture_default_str();
  verb->add_option("--theta", o.command.theta,
                   "With --routing points: paint all surface nearer than this to an edited handler point, in "
                   "units of the capture, as in the paper; 0: by the nearest handler point")
      ->capture_default_str();
}

}  // namespace

void add_edit_paint(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("paint", "Paint on the surface seen in one view", edit);
  add_pictures(verb, *o);
  add_meaning(verb, *o);
  add_material_values(verb, o->command.material);
  add_settings(verb, o->settings);
  verb->add_option("--seed", o->command.seed, "Random seed")->capture_default_str();
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    if (options.settings.list) return list_settings(console, "paint");
    const PaintCommand command = command_of(options);
    open_for_edit(session, *project, "paint --view NAME --scribble FILE.png");
    const EditSummary s = session.paint(command, console);
    finish_edit(session, console, s, text_of(s), options.output);
  });
}

}  // namespace cei3d
