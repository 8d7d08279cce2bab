// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, purpose, origin, size, image, light = "none";
  ExportRequest request;
};

std::string report_text(const ExportReport& r) {
  const std::string file = r.out.string();
  if (r.lobes > 0) return fmt::format("{}: {} light lobes.", file, r.lobes);
  if (r.triangles == 0) return fmt::format("{}: {} points.", file, r.vertices);
  std::string text = fmt::format("{}: {} vertices, {} triangles", file, r.vertices, r.triangles);
  if (r.texture > 0)
    text += fmt::format(
        ", textures of {0} x {0} texels, {1:.1f} % of them used by {2} charts (stretch {3:.3f}, {4} "
        "triangles "
        "flipped, {5} texels taken twice)",
        r.texture, 100 * r.used, r.charts, r.stretch, r.flipped, r.overlapping);
  text += ".";
  if (r.simplification_error)
    text += fmt::format(" Simplified by up to {:.2g} capture units.", *r.simplification_error);
  for (const auto& f : r.files)
    if (f != r.out) text += "\n  " + f.string();
  return text;
}

ExportRequest request_of(const Options& o) {
  ExportRequest r = o.request;
  if (!o.purpose.empty()) r.purpose = export_for_from_name(o.purpose).value_or(ExportFor::any);
  if (!o.origin.empty()) r.at_base = o.origin == "base";
  if (!o.image.empty()) r.image = export_image_from_name(o.image);
  if (!o.size.empty()) r.size = parse_length(o.size, "--size");
  r.light = o.light == "fit";
  return r;
}

void export_object(const Options& o, Session& session, Console& console) {
  const ExportRequest request = request_of(o);
  session.open(o.project, Session::Access::read);
  const std::vector<ExportReport> reports = session.export_to(request, console);
  Json list = Json::array();
  std::string text;
  for (const ExportReport& r : reports) {
    list.push_back(r.json());
    text += (text.empty() ? "" : "\n") + report_text(r);
  }
  console.done(reports.size() == 1 ? list[0] : Json{{"exports", list}}, text);
}

void add_asset_options(CLI::App* verb, Options& o) {
  verb->add_option(
      "--faces", o.request.faces,
      "Triangles, at most: simplified by quadric errors (default: 50000; a page: 100000; else without a "
      "texture: all)");
  verb->add_option(
      "--texture", o.request.texture,
      "Texels of the textures' sides: base color, occlusion-roughness-metalness, normals (default: 2048; 0, "
      "for .glb: no textures, base color by vertex)");
  verb->add_option(
          "--for", o.purpose,
          "Sizes by purpose. web: 30000 faces, 1024 texels, JPEG; ar: 50000, 2048, JPEG, origin at the "
          "base; dcc: 200000, 4096, PNG. Other options change single ones")
      ->check(CLI::IsMember({"web", "ar", "dcc"}));
  verb->add_option("--image", o.image,
                   "How base color and material are stored (default: png); normals are not lossy. webp: .glb "
                   "and .gltf only, for readers with EXT_texture_webp")
      ->check(CLI::IsMember({"png", "jpeg", "webp"}));
  verb->add_option(
          "--origin", o.origin,
          "input: the capture's own coordinates (default). base: the object stands upright in the origin")
      ->check(CLI::IsMember({"input", "base"}));
  auto* scale =
      verb->add_option("--unit-scale", o.request.unit_scale, "Meters per capture unit (default: 1)");
  verb->add_option("--size", o.size,
                   "Longest side of the object, like 0.30m, 30cm or 12in, instead of --unit-scale")
      ->excludes(scale);
  verb->add_option("--light", o.light,
                   "fit: also write the object's light as NAME.env.hdr, latitude-longitude; none (default)")
      ->check(CLI::IsMember({"fit", "none"}));
}

}  // namespace

void add_export(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("export", "Write the edited object as a file for other programs");
  verb->add_option("project", o->project, "Project folder")->required();
  verb->add_option(
          "-o,--output", o->request.out,
          "By its ending; given several times, the files share the work. .glb, .gltf, .obj, .usdz: textured "
          "mesh; .ply: mesh with albedo per vertex; .html: a page in one file that shows object and light in "
          "any browser, without network. .hdr, .exr: the light as latitude-longitude picture; .npy, .json: "
          "its "
          "lobes ([M,7]: axis, sharpness, RGB peak radiance)")
      ->required()
      ->expected(1)
      ->take_all();
  add_asset_options(verb, *o);
  verb->add_flag(
      "--points", o->request.points,
      "With .ply: instead of the mesh, the handler points with normals, albedo, footprints and the parts "
      "that they are in");
  commands.on(verb, o, export_object);
}

}  // namespace cei3d
