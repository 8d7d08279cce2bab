// SPDX-License-Identifier: Apache-2.0
// `edit deform` and `edit remove`: changes of the object's shape.
#include "apps/cli/edit_verbs.h"
#include "apps/cli/parse.h"

namespace cei3d {
namespace {

struct DragOptions {
  std::vector<std::string> from, to, turn, pin;
  std::string view, camera, pixel, drag, part, geometry = "mesh", distance = "signed";
  std::optional<double> radius;
  EditSettings settings;
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

std::vector<PointDrag> drags_of(const DragOptions& o) {
  if (o.from.size() != o.to.size()) fail_usage("There must be one --to for every --from.");
  if (!o.turn.empty() && o.turn.size() != o.from.size())
    fail_usage("There must be one --turn for every --from, or none.");
  std::vector<PointDrag> drags;
  for (size_t i = 0; i < o.from.size(); ++i) {
    drags.push_back({point_of(o.from[i], "--from"), point_of(o.to[i], "--to")});
    if (!o.turn.empty()) drags.back().turn = point_of(o.turn[i], "--turn");
  }
  return drags;
}

DeformCommand command_of(const DragOptions& o) {
  const bool points = !o.from.empty() && !o.to.empty();
  const bool pixels = o.view.empty() != o.camera.empty() && !o.pixel.empty() && !o.drag.empty();
  const bool any_point = !o.from.empty() || !o.to.empty();
  const bool any_pixel = !o.view.empty() || !o.camera.empty() || !o.pixel.empty() || !o.drag.empty();
  if (any_point == any_pixel || points == pixels)
    fail_usage(
        "Give --from X,Y,Z --to X,Y,Z, or --view NAME (or --camera FILE.json) --pixel X,Y --drag DX,DY.");
  DeformCommand c;
  if (points) {
    const std::vector<PointDrag> drags = drags_of(o);
    c.drag = drags.front();
    c.more.assign(drags.begin() + 1, drags.end());
  } else {
    if (!o.turn.empty()) fail_usage("--turn needs --from and --to.");
    c.drag = PixelDrag{o.view, pixel_of(o.pixel, "--pixel"), pixel_of(o.drag, "--drag"),
                       o.camera.empty() ? std::nullopt : std::optional(read_camera(o.camera))};
  }
  for (const std::string& pin : o.pin) c.pins.push_back(point_of(pin, "--pin"));
  if (o.distance != "signed" && o.geometry != "field") fail_usage("--distance needs --geometry field.");
  c.geometry = o.geometry;
  c.distance = o.distance;
  c.radius = o.radius;
  c.part = o.part;
  c.set = o.settings.set;
  return c;
}

std::string deform_text(const EditSummary& s) {
  return fmt::format("{}: moved {} vertices within {:.3g} of the handle by at most {:.3g}; {}.", s.id,
                     s.report.at("vertices").get<size_t>(), s.report.at("radius").get<double>(),
                     s.report.at("farthest").get<double>(), stages_text(s));
}

// Points to drag and pins, in space or in a view.
void add_points(CLI::App* verb, DragOptions& o) {
  const auto each = [&](const char* name, std::vector<std::string>& values, const char* help) {
    verb->add_option(name, values, help)->expected(1)->take_all();
  };
  each("--from", o.from, "Point on the surface to drag, X,Y,Z in the capture's frame; again for more points");
  each("--to", o.to, "Where the point goes, X,Y,Z in the capture's frame; one for each --from");
  each("--turn", o.turn,
       "Rotation of the surface around the point, X,Y,Z: axis in the capture's frame times angle in degrees; "
       "one for each --from, or none");
  each(
      "--pin", o.pin,
      "Point on the surface around which nothing moves, X,Y,Z in the capture's frame; again for more points");
  verb->add_option("--view", o.view, "Instead of --from and --to: name of a view to drag in");
  verb->add_option("--camera", o.camera, "Instead of --view: " + std::string(kCameraHelp));
  verb->add_option("--pixel", o.pixel,
                   "With --view: pixel of the point to drag, X,Y (column, row from the top left corner)");
  verb->add_option("--drag", o.drag, "With --view: movement in pixels, DX,DY, at the depth of the point");
}

void add_deform(Commands& commands, CLI::App* edit, ProjectName project) {
  auto o = std::make_shared<DragOptions>();
  CLI::App* verb = commands.add("deform", "Drag a point of the surface; its surroundings follow", edit);
  add_points(verb, *o);
  verb->add_option("--radius", o->radius,
                   "Distance along the surface up to which it moves, capture units (default: 0.3 of the "
                   "object's radius, or 1.5 times the drag if that is more)");
  verb->add_option("--part", o->part, "Move only this part");
  verb->add_option(
          "--geometry", o->geometry,
          "mesh: the object's distance field stays, and is read through the deformation of its mesh. "
          "field: a copy of the field is trained until its surface is the deformed one")
      ->check(CLI::IsMember({"mesh", "field"}))
      ->capture_default_str();
  verb->add_option("--distance", o->distance,
                   "With --geometry field, what it is trained on. signed: distances to the deformed surface, "
                   "negative inside. l1: as the paper prints it, without a sign")
      ->check(CLI::IsMember({"signed", "l1"}))
      ->capture_default_str();
  add_settings(verb, o->settings);
  add_output(verb, o->output);
  commands.on(verb, o, [project](const DragOptions& options, Session& session, Console& console) {
    if (options.settings.list) return list_settings(console, "deform");
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
