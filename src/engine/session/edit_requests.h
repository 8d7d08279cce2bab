// SPDX-License-Identifier: Apache-2.0
// Requests to edit an object, as the user writes them, and their result: plain data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/math/camera.h"
#include "engine/edit/routing.h"
#include "engine/segment/view_plan.h"

namespace cei3d {

// Changes of material and color, as the user writes them.
struct MaterialEffects {
  std::string preset;  // name of a material, "gold"; the members below override its values
  std::optional<double> roughness, specular, metalness;  // [0, 1]
  std::optional<double> roughness_scale;  // factor on the present roughness; the result is clamped to 1
  std::string color;                      // "#RRGGBB", sRGB; empty: the preset's or the present
  bool replace = false;  // the color replaces the texture instead of scaling it; that of a preset always does
  std::optional<double> blend;  // [0, 1], share of the new values; the rest is the present value; none: 1
  bool empty() const {
    return preset.empty() && !roughness && !specular && !metalness && !roughness_scale && color.empty();
  }
};
// For help: "gold, silver, ...".
std::string material_preset_names();
// Empty if there is a preset of that name; else an error message with similar names.
std::string unknown_preset(const std::string& name);

// A file that an edit is made from. The bytes may be given; else they are read from the path.
struct InputFile {
  InputFile() = default;
  InputFile(std::filesystem::path file) : path(std::move(file)) {}
  std::filesystem::path path;
  std::optional<std::string> bytes;
  bool empty() const { return path.empty() && !bytes; }
  std::string read() const;  // errors: missing, unreadable
};

// Where a picture is laid onto the surface.
struct DecalPlace {
  Vec2<double> pixel;       // of its middle in the view: (column, row), pixel centers at +0.5
  double width = 0;         // of the picture, capture units, > 0
  double turn_degrees = 0;  // clockwise as the view shows it; 0: upright in the view
};
struct PaintStroke {
  std::string view;                      // a view's name
  InputFile scribble;                    // RGBA PNG of the view's size
  std::optional<Camera> camera = {};     // instead of a view, capture frame
  std::optional<DecalPlace> decal = {};  // `scribble` is a picture, PNG or JPEG, that is laid here
};
enum class PaintTarget {
  albedo,      // the albedo
  appearance,  // the color in the painted view under the present light; the albedo follows from it
  radiance     // the color in every view under every light: shown without shading
};
struct PaintCommand {
  std::vector<PaintStroke> strokes;  // later strokes cover earlier ones
  uint64_t seed = 1;
  PaintTarget target = PaintTarget::albedo;  // meaning of the colors of the scribble
  Routing routing = Routing::both;
  double theta = 0;  // with Routing::points: distance to edited handler points, capture units; 0: the nearest
  bool erase = false;              // restore the base's albedo and material where the scribble paints
  std::vector<std::string> set{};  // "key=value" of branch_settings() (engine/edit/albedo_branch.h)
  // Material of the painted surface. The only color allowed is that of a preset; it replaces those of the
  // scribbles.
  MaterialEffects material{};
};
struct MaterialCommand {
  std::string part;  // its name; empty: the whole object
  MaterialEffects effects;
};

// Drag of a surface point, capture frame.
struct PointDrag {
  Vec3d from, to;
  Vec3d turn{0, 0, 0};  // rotation of the surface around the point: axis times angle in degrees
};
// Drag of the surface point seen at `pixel` by `drag` pixels, in the plane through it parallel to the image.
struct PixelDrag {
  std::string view;
  Vec2<double> pixel, drag;           // (column, row), pixel centers at +0.5
  std::optional<Camera> camera = {};  // instead of a view, capture frame
};
struct DeformCommand {
  std::variant<PointDrag, PixelDrag> drag;
  std::optional<double> radius;     // along the surface, capture units
  std::string part;                 // empty: the whole object
  std::vector<PointDrag> more{};    // further points that are dragged at once
  std::vector<Vec3d> pins{};        // points of the surface around which nothing moves, capture frame
  std::string geometry = "mesh";    // "mesh", or "field": the moved surface gets a distance field of its own
  std::string distance = "signed";  // what that field is fitted to: "signed" distances or "l1", the paper's
  std::vector<std::string> set{};   // "key=value" of deform_settings() (engine/edit/deform.h)
};
// How the segmentation network sees the object.
struct NetworkViews {
  bool photographs = false;  // of the training views; else renders of the albedo
  ViewPlan plan;
};
// A part by clicks, strokes, a mask or a clicked material in one view, and optional changes of its material
// and color.
struct PartCommand {
  std::string view;
  std::vector<Vec2<double>> positive, negative;  // (column, row), pixel centers at +0.5
  // RGBA PNGs of the view's size, besides clicks: strokes on the part, which give it their color or pattern,
  // and beside it. Empty: none.
  std::filesystem::path scribble{}, negative_scribble{};
  std::string negative_color{};          // '#RRGGBB', sRGB: strokes of `scribble` beside the part
  bool keep_color = false;               // do not take the scribble's color
  bool keep_texture = false;             // the scribble's color scales the texture
  InputFile mask;                        // PNG in place of clicks; empty: none
  std::optional<Vec2<double>> like{};    // instead of clicks: surface with the material at this pixel
  bool like_color = false;               // compare the albedo, too
  std::string segmenter = "grow";        // or "sam"
  NetworkViews network{};                // with "sam"
  bool in_view = false;                  // only the surface that this view shows
  std::string name;                      // empty: that of the part combined with, else "part1", "part2", ...
  std::string add, subtract, intersect;  // name of a part to combine with; at most one
  MaterialEffects effects;
  std::optional<Camera> camera = {};  // instead of a view, capture frame
  std::vector<std::string> set{};     // "key=value" of part_settings() (engine/edit/part.h)
};
struct RemoveCommand {
  std::string part;
};
// Result of an edit.
struct EditSummary {
  std::string id;
  Json report;  // by kind of edit; "seconds": of its stages
  double load_seconds = 0, store_seconds = 0;
  double seconds(const char* stage) const { return report.at("seconds").at(stage).get<double>(); }
  Json json() const;
};

enum class EnvConvention { by_up_axis, zup, yup, mitsuba, blender };
std::optional<EnvConvention> env_convention_from_name(const std::string&);  // "zup", ...

// A small distant light, added to the others.
struct Sun {
  Vec3d direction{0, 0, 1};  // towards it, capture frame; any length
  // Of what a surface that faces it receives, in units of what the rest of the light gives to a surface on
  // average.
  double strength = 1;
};

struct LightChoice {
  // Latitude-longitude image, or .npy of lobes as exported; empty: the object's own light.
  std::filesystem::path env;
  double rotate_degrees = 0;  // counter-clockwise about the up axis, seen from above
  EnvConvention convention = EnvConvention::by_up_axis;
  double scale = 1;             // times the radiance
  std::optional<Sun> sun = {};  // neither turned nor scaled with the rest
  bool is_own() const { return env.empty() && rotate_degrees == 0 && scale == 1 && !sun; }
};

// Every edit.
using EditCommand =
    std::variant<PaintCommand, MaterialCommand, LightChoice, DeformCommand, RemoveCommand, PartCommand>;

// Names as on the command line; none: unknown name.
std::optional<PaintTarget> paint_target_from_name(const std::string&);
std::optional<Routing> routing_from_name(const std::string&);
const char* paint_target_name(PaintTarget);
const char* routing_name(Routing);
std::optional<ViewOrder> view_order_from_name(const std::string&);              // "informative", "adjacent"
std::optional<MaskCombination> mask_combination_from_name(const std::string&);  // "votes", "any"

}  // namespace cei3d
