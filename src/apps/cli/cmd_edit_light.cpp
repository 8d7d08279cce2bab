// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct Options {
  LightChoice light;
  std::string env, convention, sun;
  double sun_strength = 1;
  bool amend = false;
  EditOutput output;
};

}  // namespace

void add_edit_light(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("light", "Replace, rotate or scale the light", edit);
  CLI::Option* env =
      verb->add_option(
              "--env", o->env,
              "New light: a latitude-longitude image (.hdr, .exr), or lobes as `export` writes them (.npy)")
          ->check(CLI::ExistingFile);
  verb->add_option("--env-convention", o->convention,
                   "Axes of the image: zup, yup, mitsuba, blender (default: from the capture's up axis)")
      ->needs(env);
  verb->add_option("--rotate", o->light.rotate_degrees,
                   "Rotate the light around the up axis, degrees, counter-clockwise seen from above");
  verb->add_option("--scale", o->light.scale, "Multiply the light by this factor");
  CLI::Option* sun =
      verb->add_option("--sun", o->sun, "Add a sun: X,Y,Z towards it in the capture's frame, of any length");
  verb->add_option(
          "--sun-strength", o->sun_strength,
          "What a surface that faces the sun receives from it, in units of what the rest of the light "
          "gives to a surface on average")
      ->needs(sun)
      ->capture_default_str();
  add_amend(verb, o->amend);
  add_output(verb, o->output);
  commands.on(verb, o, [project](const Options& options, Session& session, Console& console) {
    LightChoice choice = options.light;
    choice.env = options.env;
    if (!options.convention.empty()) choice.convention = parse_env_convention(options.convention);
    if (!options.sun.empty()) {
      const std::vector<double> d = parse_numbers(options.sun, 3, "--sun");
      choice.sun = Sun{{d[0], d[1], d[2]}, options.sun_strength};
    }
    open_for_edit(session, *project, "light --env FILE");
    const EditSummary s = session.edit(choice, console, options.amend);
    finish_edit(
        session, console, s,
        fmt::format("{}: light of {} lobes; {}.", s.id, s.report.at("lobes").get<size_t>(), stages_text(s)),
        options.output);
  });
}

}  // namespace cei3d
