// SPDX-License-Identifier: Apache-2.0
// `edit deform` and `edit remove`: changes of the object's shape.
#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct DeformOptions {
  std::string from, to, view, camera, pixel, drag, part;
  std::optional<double> radius;
  EditOutput output;
};

struct RemoveOptions {
  RemoveCommand command;
  EditOutput output;
};

Vec3d point_of(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_numbers(text, 3, option);
  return {v[0], v[1], v[2]};
}

Vec2<double> pixel_of(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_numbers(text, 2, option);
  return {v[0], v[1]};
}

DeformCommand command_of(const DeformOptions& o) {
  const bool points = !o.from.empty() && !o.to.empty();
  const bool pixels = o.view.empty() != o.camera.empty() && !o.pixel.empty() && !o.drag.empty();
  const bool any_point = !o.from.empty() || !o.to.empty();
  const bool any_pixel = !o.view.empty() || !o.camera.empty() || !o.pixel.empty() || !o.drag.empty();
  if (any_point == any_pixel || points == pixels)
    fail_usage(
        "Give --from X,Y,Z --to X,Y,Z, or --view NAME (or --camera FILE.json) --pixel X,Y --drag DX,DY.");
  DeformCommand c;
  if (points)
    c.drag = PointDrag{point_of(o.from, "--from"), point_of(o.to, "--to")};
  else
    c.drag = PixelDrag{o.view, pixel_of(o.pixel, "--pixel"), pixel_of(o.drag, "--drag"),
                       o.camera.empty() ? std::nullopt : std::optional(read_camera(o.camera))};
  c.radius = o.radius;
  c.part = o.part;
  return c;
}

std::string deform_text(const EditSummary& s) {
  return fmt::format("{}: moved {} vertices within {:.3g} of the handle by at most {:.3g}; {}.", s.id,
                     s.report.at("vertices").get<size_t>(), s.report.at("radius").get<double>(),
                     s.report.at("farthest").get<double>(), stages_text(s));
}

void add_deform(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<DeformOptions>();
  CLI::App* verb = commands.add("deform", "Drag a point of the surface; its surroundings follow", edit);
  verb->add_option("--from", o->from, "Point on the surface to drag, X,Y,Z in the capture's frame");
  verb->add_option("--to", o->to, "Where the point goes, X,Y,Z in the capture's frame");
  verb->add_option("--view", o->view, "Instead of --from and --to: name of a view to drag in");
  verb->add_option("--camera", o->camera, "Instead of --view: " + std::string(kCameraHelp));
  verb->add_option("--pixel", o->pixel,
                   "With --view: pixel of the point to drag, X,Y (column, row from the top left corner)");
  verb->add_option("--drag", o->drag, "With --view: movement in pixels, DX,DY, at the depth of the point");
  verb->add_option("--radius", o->radius,
                   "Distance along the surface up to which it moves, capture units (default: 0.3 of the "
                   "object's radius, or 1.5 times the drag if that is more)");
  verb->add_option("--part", o->part, "Move only this part");
  add_output(verb, o->output);
  commands.on(verb, o, [project](const DeformOptions& options, Session& session, Console& console) {
    const DeformCommand command = command_of(options);
    open_for_edit(session, *project, "deform --from X,Y,Z --to X,Y,Z");
    const EditSummary s = session.deform(command, console);
    finish_edit(session, console, s, deform_text(s), options.output);
  });
}

void add_remove(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<RemoveOptions>();
  CLI::App* verb = commands.add("remove", "Remove a part and close the surface behind it", edit);
  verb->add_option("--part", o->command.part, "Name of the part; `cei3d parts` lists them")->required();
  add_output(verb, o->output);
  commands.on(verb, o, [project](const RemoveOptions& options, Session& session, Console& console) {
    open_for_edit(session, *project, "remove --part NAME");
    const EditSummary s = session.remove(options.command, console);
    finish_edit(session, console, s, remove_text(s), options.output);
  });
}

}  // namespace

std::string remove_text(const EditSummary& s) {
  const auto count = [&](const char* key) { return s.report.at(key).get<size_t>(); };
  std::string text =
      fmt::format("{}: {} triangles removed, {} holes closed by {} new ones; {}.", s.id,
                  count("removed_triangles"), count("holes"), count("added_triangles"), stages_text(s));
  if (count("pieces") > 1) text += fmt::format(" The object now has {} pieces.", count("pieces"));
  return text;
}

void add_edit_shape(Commands& commands, CLI::App* edit, ProjectName project) {
  add_deform(commands, edit, project);
  add_remove(commands, edit, project);
}

}  // namespace cei3d
