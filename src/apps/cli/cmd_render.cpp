// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, out, cameras, channels = "rgb", size, env, convention;
  double rotate = 0;
  int turntable = 0, samples = 2;
  bool residual = true;
};

RenderRequest request_of(const Options& o) {
  RenderRequest r;
  r.out = o.out;
  r.channels = parse_channels(o.channels);
  if (!o.cameras.empty()) r.cameras = parse_cameras(o.cameras);
  if (o.turntable > 0) r.cameras = Turntable{o.turntable};
  if (!o.size.empty()) {
    const ImageExtent size = parse_size(o.size);
    r.width = size.width;
    r.height = size.height;
  }
  r.samples = o.samples;
  r.residual = o.residual;
  r.light.env = o.env;
  r.light.rotate_degrees = o.rotate;
  if (!o.convention.empty()) r.light.convention = parse_env_convention(o.convention);
  return r;
}

void render(const Options& o, Session& session, Console& console) {
  const RenderRequest request = request_of(o);
  session.open(o.project, Session::Access::read);
  const RenderReport r = session.render(request, console);
  console.done(
      r.json(),
      fmt::format("{}: {} view{}, {} channel{} in {:.1f} s ({:.2f} s per view: trace {:.2f}, shade {:.2f}).",
                  o.out, r.views, r.views == 1 ? "" : "s", r.folders.size(), r.folders.size() == 1 ? "" : "s",
                  r.seconds, r.seconds / double(r.views), r.trace_seconds / double(r.views),
                  r.shade_seconds / double(r.views)));
}

}  // namespace

void add_render(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb =
      commands.add("render", "Render images of a project: DIR/CHANNEL/VIEW.png, and DIR/render.json");
  verb->add_option("project", o->project, "Project folder")->required();
  verb->add_option("-o,--output", o->out, "Folder for the images")->required();
  CLI::Option* cameras = verb->add_option(
      "--cameras", o->cameras,
      "CAPTURE, CAPTURE:train, :val or :test, or a FILE.json with cameras, such as a render.json (default: "
      "the project's held-out views, or all views when there are none)");
  verb->add_option("--turntable", o->turntable,
                   "N views on a circle around the up axis, at the mean distance and height of the cameras")
      ->check(CLI::Range(1, 100000))
      ->excludes(cameras);
  verb->add_option("--channels", o->channels,
                   "Comma-separated: rgb, albedo, diffuse, specular (RGBA, sRGB, straight alpha), normal "
                   "(world space of the capture, (n+1)/2, 16-bit), depth (z-depth, 16-bit, scale in "
                   "render.json), roughness, metalness, mask (gray)")
      ->capture_default_str();
  verb->add_option(
      "--size", o->size,
      "Image size, WxH pixels; the horizontal field of view is kept (default: that of the cameras)");
  add_samples(verb, o->samples);
  CLI::Option* env =
      verb->add_option(
              "--env", o->env,
              "Light the object by this latitude-longitude image (.hdr, .exr) instead of its own light")
          ->check(CLI::ExistingFile);
  verb->add_option("--env-rotate", o->rotate,
                   "Rotate the light around the up axis, degrees, counter-clockwise seen from above")
      ->capture_default_str();
  verb->add_option("--env-convention", o->convention,
                   "Axes of the image: zup, yup, mitsuba, blender (default: from the capture's up axis)")
      ->needs(env);
  add_residual_switch(verb, o->residual);
  commands.on(verb, o, render);
}

}  // namespace cei3d
