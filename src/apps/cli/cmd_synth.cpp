// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "engine/session/edit_params.h"
#include "engine/synthetic/synthetic_capture.h"

namespace cei3d {
namespace {

struct Options {
  std::vector<std::string> materials;
  std::string size = "200x200", tint, diffuse = "burley", layout = "nerf";
  double roughness = -1;
  SynthRequest request;
};

// "lid=0.3,0.5,0,#c04020" or with a second color: roughness, specular, metalness, albedo.
RegionFinish parse_region(const std::string& text) {
  const size_t equals = text.find('='), color = text.find(",#");
  if (equals == std::string::npos || color == std::string::npos || color < equals)
    fail_usage(
        "--material '{}' should be the name of a set, or REGION=ROUGHNESS,SPECULAR,METALNESS,#RRGGBB with a "
        "second #RRGGBB for a texture of two colors, for example lid=0.3,0.5,0,#c04020.",
        text);
  RegionFinish out;
  out.region = text.substr(0, equals);
  const std::vector<double> v =
      parse_numbers(text.substr(equals + 1, color - equals - 1), 3, "--material " + out.region);
  out.finish.material = {float(v[0]), float(v[1]), float(v[2])};
  const size_t second = text.find(',', color + 1);
  out.finish.color = color_from_text(text.substr(color + 1, second - color - 1));
  if (second != std::string::npos) out.finish.second_color = color_from_text(text.substr(second + 1));
  return out;
}

Vec3f parse_tint(const std::string& text) {
  const std::vector<double> v = parse_numbers(text, 3, "--light-tint");
  for (const double x : v)
    if (!(x >= 0 && x <= 1000)) fail_usage("--light-tint '{}': a factor lies between 0 and 1000.", text);
  return {float(v[0]), float(v[1]), float(v[2])};
}

SynthRequest request_of(const Options& o) {
  SynthRequest r = o.request;
  for (const std::string& m : o.materials) {
    if (m.find('=') == std::string::npos)
      r.material = m;
    else
      r.regions.push_back(parse_region(m));
  }
  const ImageExtent size = parse_size(o.size);
  r.width = size.width, r.height = size.height;
  if (!o.tint.empty()) r.light_tint = parse_tint(o.tint);
  if (o.roughness >= 0) r.roughness = float(o.roughness);
  if (o.diffuse == "lambert") r.diffuse = Diffuse::lambert;
  if (o.layout == "physg") r.layout = SynthLayout::physg;
  return r;
}

void synth(const Options& o, Session&, Console& console) {
  const SynthReport r = make_capture(request_of(o), console);
  console.done(r.json(), fmt::format("{}: {} training views, {} test views, {} relit views in {:.1f} s.",
                                     r.out.string(), r.views, r.test_views, r.relit_views, r.seconds));
}

void add_scene_options(CLI::App* verb, Options& o) {
  SynthRequest& r = o.request;
  verb->add_option("--shape", r.shape, "ball, box or teapot")->capture_default_str();
  verb->add_option("--material", o.materials,
                   "What it is made of; repeatable. A set for all regions: plastic, gloss, clay, copper (one "
                   "material each), enamel (several) (default: plastic); or one region anew: "
                   "REGION=ROUGHNESS,SPECULAR,METALNESS,#RRGGBB, and a second ,#RRGGBB for a texture of two "
                   "colors. Regions: body, band, lid, and of the teapot also trim");
  verb->add_option("--roughness", o.roughness,
                   "Roughness of every region, whatever the material says: 0.7 weakens all highlights")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--light", r.light,
                   "daylight, evening or studio; the test views are relit under the two others")
      ->capture_default_str();
  verb->add_option("--light-tint", o.tint, "R,G,B: factors of the light's color, for example 1,0.7,0.45");
  verb->add_option("--light-strength", r.light_strength, "Factor of the light")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  verb->add_flag("--light-turns", r.light_turns,
                 "The object stands on a turntable under fixed lamps: in its frame the light turns with the "
                 "camera about z");
}

void add_drawing_options(CLI::App* verb, Options& o) {
  SynthRequest& r = o.request;
  verb->add_option("--size", o.size, "Size of the images in pixels, WxH")->capture_default_str();
  verb->add_option("--views", r.views, "Training views")->check(CLI::Range(1, 1000))->capture_default_str();
  verb->add_option("--test-views", r.test_views, "Test views; every second one is relit")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  verb->add_option("--samples", r.samples, "Paths per pixel; powers of two are stratified best")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  verb->add_option("--bounces", r.bounces, "Maximum number of interreflections")
      ->check(CLI::Range(0, 16))
      ->capture_default_str();
  verb->add_option("--diffuse", o.diffuse,
                   "Diffuse base under the GGX highlights: burley (darker or brighter at flat angles, by "
                   "roughness, as the program's own shading assumes) or lambert")
      ->check(CLI::IsMember({"burley", "lambert"}))
      ->capture_default_str();
  verb->add_option("--noise", r.noise,
                   "Standard deviation of the noise on the training images, of sRGB values from 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--layout", o.layout,
                   "Files of the views. nerf: NeRF-synthetic, 8-bit PNG. physg: PhySG, linear EXR, with "
                   "radiance above 1")
      ->check(CLI::IsMember({"nerf", "physg"}))
      ->capture_default_str();
  verb->add_option("--seed", r.seed, "Random seed")->capture_default_str();
}

}  // namespace

void add_synth(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("synth",
                                "Draw a capture of a made-up object by path tracing, with true light, "
                                "material, normals and relit views");
  verb->add_option("-o,--output", o->request.out, "Folder for the capture: a new or an empty one")
      ->required();
  add_scene_options(verb, *o);
  add_drawing_options(verb, *o);
  commands.on(verb, o, synth);
}

}  // namespace cei3d
