// SPDX-License-Identifier: Apache-2.0
#include "apps/server/edit_json.h"

#include <algorithm>

#include "core/base/json.h"
#include "model/geometry/shape/camera_json.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

MaterialEffects effects_from(JsonReader& j) {
  MaterialEffects e;
  e.preset = j.optional<std::string>("material", "");
  e.roughness = j.optional<double>("roughness");
  e.specular = j.optional<double>("specular");
  e.metalness = j.optional<double>("metalness");
  e.roughness_scale = j.optional<double>("roughness_scale");
  e.color = j.optional<std::string>("color", "");
  e.replace = j.optional("replace", false);
  e.blend = j.optional<double>("blend");
  return e;
}

// "view" or "camera".
void read_place(JsonReader& j, std::string& view, std::optional<Camera>& camera) {
  view = j.optional<std::string>("view", "");
  if (j.has("camera")) camera = camera_member(j, "camera");
}

template <class Enum>
std::optional<Enum> optional_named(JsonReader& j, const char* key,
                                   std::optional<Enum> (*from_name)(const std::string&)) {
  const auto name = j.optional<std::string>(key);
  if (!name) return std::nullopt;
  const std::optional<Enum> value = from_name(*name);
  if (!value) fail_usage("{}: there is no {} '{}'.", j.what(), key, *name);
  return value;
}

template <class Enum>
Enum named(JsonReader& j, const char* key, std::optional<Enum> (*from_name)(const std::string&),
           const char* otherwise) {
  return optional_named(j, key, from_name).value_or(*from_name(otherwise));
}

Vec2<double> pixel_from(JsonReader& j, const char* key) {
  const auto [x, y] = j.numbers<2>(key);
  return {x, y};
}

std::vector<Vec2<double>> pixels_from(JsonReader& j, const char* key) {
  std::vector<Vec2<double>> pixels;
  if (!j.has(key)) return pixels;
  for (const Json& p : j.array(key)) {
    const Json pair = {{"at", p}};
    JsonReader reader(pair, "A click");
    pixels.push_back(pixel_from(reader, "at"));
  }
  return pixels;
}

// A scribble or mask. Its limit is lower than that of /api/upload, which must let environments through, too.
InputFile sent_picture(const Uploads& uploads, const std::string& id) {
  constexpr uintmax_t kMiB = 1 << 20, kMaxMiB = 64;
  const uintmax_t bytes = std::filesystem::file_size(uploads.path(id));
  if (bytes > kMaxMiB * kMiB)
    fail_usage("A scribble, decal or mask has at most {} MiB, not {} bytes; send a smaller one.", kMaxMiB,
               bytes);
  InputFile file;
  file.bytes = uploads.bytes(id);
  return file;
}

PaintCommand paint_from(JsonReader& j, const Uploads& uploads) {
  PaintCommand c;
  for (const Json& s : j.array("strokes")) {
    JsonReader reader(s, "A stroke");
    PaintStroke stroke;
    read_place(reader, stroke.view, stroke.camera);
    stroke.scribble = sent_picture(uploads, reader.require<std::string>("scribble"));
    if (reader.has("decal")) stroke.decal = decal_place(reader);
    reader.finish();
    c.strokes.push_back(std::move(stroke));
  }
  if (c.strokes.empty()) fail_usage("The request has no strokes to paint.");
  c.seed = j.optional<uint64_t>("seed", 1);
  c.target = named(j, "target", paint_target_from_name, "albedo");
  c.routing = named(j, "routing", routing_from_name, "both");
  c.erase = j.optional("erase", false);
  c.material = effects_from(j);
  return c;
}

PointDrag drag_from(JsonReader& j) {
  PointDrag d{vector_from(j, "from"), vector_from(j, "to")};
  if (j.has("turn")) d.turn = vector_from(j, "turn");
  return d;
}

void read_more_points(JsonReader& j, DeformCommand& c) {
  if (j.has("more"))
    for (const Json& more : j.array("more")) {
      JsonReader reader(more, "A handle");
      c.more.push_back(drag_from(reader));
      reader.finish();
    }
  if (!j.has("pins")) return;
  for (const Json& pin : j.array("pins")) {
    const Json named = {{"at", pin}};
    JsonReader reader(named, "A pin");
    c.pins.push_back(vector_from(reader, "at"));
  }
}

DeformCommand deform_from(JsonReader& j) {
  DeformCommand c;
  if (j.has("from")) {
    c.drag = drag_from(j);
  } else {
    PixelDrag drag;
    read_place(j, drag.view, drag.camera);
    drag.pixel = pixel_from(j, "pixel");
    drag.drag = pixel_from(j, "drag");
    c.drag = drag;
  }
  read_more_points(j, c);
  c.radius = j.optional<double>("radius");
  c.part = j.optional<std::string>("part", "");
  return c;
}

PartCommand part_from(JsonReader& j, const Uploads& uploads) {
  PartCommand c;
  read_place(j, c.view, c.camera);
  c.positive = pixels_from(j, "positive");
  c.negative = pixels_from(j, "negative");
  if (const auto mask = j.optional<std::string>("mask")) {
    c.mask = sent_picture(uploads, *mask);
    c.mask.path = "mask.png";
  }
  if (j.has("like")) c.like = pixel_from(j, "like");
  c.like_color = j.optional("like_color", false);
  c.segmenter = j.optional<std::string>("segmenter", "grow");
  c.network.plan.max_views = j.optional("views", c.network.plan.max_views);
  c.in_view = j.optional("in_view", false);
  c.name = j.optional<std::string>("name", "");
  c.add = j.optional<std::string>("add", "");
  c.subtract = j.optional<std::string>("subtract", "");
  c.intersect = j.optional<std::string>("intersect", "");
  c.effects = effects_from(j);
  return c;
}

EditCommand command_from(const std::string& op, JsonReader& j, const Uploads& uploads) {
  if (op == "paint") return paint_from(j, uploads);
  if (op == "deform") return deform_from(j);
  if (op == "part") return part_from(j, uploads);
  if (op == "light") return light_choice(j, uploads);
  if (op == "remove") return RemoveCommand{j.require<std::string>("part")};
  if (op != "material") fail_usage("There is no edit '{}'.", op);
  MaterialCommand c;
  c.part = j.optional<std::string>("part", "");
  c.effects = effects_from(j);
  return c;
}

}  // namespace

EditCommand edit_command(const std::string& op, const Json& params, const Uploads& uploads) {
  JsonReader reader(params, "The request for '" + op + "'");
  EditCommand command = command_from(op, reader, uploads);
  reader.finish();
  return command;
}

Camera camera_member(JsonReader& j, const char* key) {
  JsonReader reader = j.object(key);
  const Camera camera = camera_from_json(reader);
  reader.finish();
  return camera;
}

DecalPlace decal_place(JsonReader& j) {
  JsonReader reader = j.object("decal");
  DecalPlace place{pixel_from(reader, "pixel"), reader.require<double>("width"),
                   reader.optional("turn", 0.0)};
  reader.finish();
  return place;
}

LightChoice light_choice(JsonReader& j, const Uploads& uploads) {
  LightChoice c;
  if (const auto env = j.optional<std::string>("env"); env && !env->empty()) c.env = uploads.path(*env);
  c.rotate_degrees = j.optional("rotate", 0.0);
  c.scale = j.optional("scale", 1.0);
  if (const auto name = j.optional<std::string>("env_convention"))
    c.convention = named(j, "env_convention", env_convention_from_name, name->c_str());
  if (!j.has("sun")) return c;
  JsonReader sun = j.object("sun");
  c.sun = Sun{vector_from(sun, "direction"), sun.optional("strength", 1.0)};
  sun.finish();
  return c;
}

FrameRequest frame_request(JsonReader& j, const Uploads& uploads) {
  constexpr int kMaxSide = 2048, kMaxSamples = 4;
  FrameRequest r;
  r.camera = camera_member(j, "camera");
  if (r.camera.width > kMaxSide || r.camera.height > kMaxSide)
    fail_usage("A frame has at most {} pixels a side.", kMaxSide);
  r.channel = named(j, "channel", channel_from_name, "rgb");
  r.samples = j.optional("samples", 1);
  if (r.samples < 1 || r.samples > kMaxSamples)
    fail_usage("A frame has 1 to {} samples a pixel and axis.", kMaxSamples);
  if (j.has("light")) {
    JsonReader light = j.object("light");
    r.light = light_choice(light, uploads);
    light.finish();
  }
  r.as_photographed = j.optional("as_photographed", false);
  return r;
}

ExportRequest export_request(JsonReader& j) {
  ExportRequest r;
  r.out = {plain_file_name(j.require<std::string>("file"))};
  r.purpose = optional_named(j, "for", export_for_from_name).value_or(ExportFor::any);
  r.faces = j.optional<int>("faces");
  r.texture = j.optional<int>("texture");
  r.image = optional_named(j, "image", export_image_from_name);
  if (const auto origin = j.optional<std::string>("origin")) {
    if (*origin != "input" && *origin != "base")
      fail_usage("{}: there is no origin '{}'.", j.what(), *origin);
    r.at_base = *origin == "base";
  }
  if (j.has("size") && j.has("unit_scale")) fail_usage("{}: size or unit_scale, not both.", j.what());
  r.unit_scale = j.optional("unit_scale", r.unit_scale);
  r.size = j.optional("size", r.size);
  r.points = j.optional("points", false);
  r.light = j.optional("light", false);
  return r;
}

RenderRequest turntable_request(JsonReader& j) {
  constexpr int kMaxFrames = 720, kMaxSide = 4096, kMaxSamples = 4;
  RenderRequest r;
  const auto frames = j.require<int>("turntable");
  r.samples = j.optional("samples", r.samples);
  if (frames < 1 || frames > kMaxFrames) fail_usage("A turntable has 1 to {} frames.", kMaxFrames);
  if (r.samples < 1 || r.samples > kMaxSamples)
    fail_usage("A frame has 1 to {} samples a pixel and axis.", kMaxSamples);
  r.cameras = Turntable{frames};
  if (!j.has("size")) return r;
  const auto [width, height] = j.numbers<2>("size");
  if (!(std::min(width, height) >= 1 && std::max(width, height) <= kMaxSide))
    fail_usage("A frame has 1 to {} pixels a side.", kMaxSide);
  r.width = int(width);
  r.height = int(height);
  return r;
}

}  // namespace cei3d
