// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/export/file_names.h"
#include "engine/export/gltf.h"
#include "engine/export/gltf_asset.h"
#include "engine/export/make_asset.h"
#include "engine/export/obj.h"
#include "engine/export/object_mesh.h"
#include "engine/export/usdz.h"
#include "engine/io/exr_file.h"
#include "engine/io/hdr_file.h"
#include "engine/io/npy.h"
#include "engine/io/ply.h"
#include "engine/page/object_page.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/render/scene_light.h"
#include "engine/session/session.h"
#include "engine/view/reflection_fit.h"
#include "engine/view/view_light.h"
#include "engine/view/view_mesh.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

struct Preset {
  int faces = 50000, texture = 2048;
  ExportImage image = ExportImage::png;
  bool at_base = false;
  int page_faces = 100000;
};

Preset preset_of(ExportFor purpose) {
  switch (purpose) {
    case ExportFor::web:
      return {30000, 1024, ExportImage::jpeg, false, 60000};
    case ExportFor::ar:
      return {50000, 2048, ExportImage::jpeg, true};
    case ExportFor::dcc:
      return {200000, 4096, ExportImage::png, false, 400000};
    case ExportFor::any:
      break;
  }
  return {};
}

PictureKind picture_kind(ExportImage image) {
  switch (image) {
    case ExportImage::jpeg:
      return PictureKind::jpeg;
    case ExportImage::webp:
      return PictureKind::webp;
    case ExportImage::png:
      break;
  }
  return PictureKind::png;
}

bool has(const std::string& kind, std::initializer_list<const char*> kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

bool is_length(double meters) { return meters >= kMinExportLength && meters <= kMaxExportLength; }

void check_sizes(const ExportRequest& r) {
  constexpr int kMinTexture = 64, kMaxTexture = 8192, kMinFaces = 4, kMaxFaces = 20'000'000;
  if (r.texture && *r.texture != 0 && (*r.texture < kMinTexture || *r.texture > kMaxTexture))
    fail_usage("Texture {}: the side of a texture is {} to {} texels, or 0 for none.", *r.texture,
               kMinTexture, kMaxTexture);
  if (r.faces && (*r.faces < kMinFaces || *r.faces > kMaxFaces))
    fail_usage("Faces {}: a mesh has {} to {} faces.", *r.faces, kMinFaces, kMaxFaces);
  if (!is_length(r.unit_scale))
    fail_usage("Unit scale {}: meters per unit of the capture, {} to {}.", r.unit_scale, kMinExportLength,
               kMaxExportLength);
  if (r.size != 0 && !is_length(r.size))
    fail_usage("Size {}: meters, {} to {}.", r.size, kMinExportLength, kMaxExportLength);
}

// What no file of the request can hold is refused; of several files, those get it that can.
void check_use(const ExportRequest& r) {
  const bool placed = r.at_base.value_or(false) || r.unit_scale != 1 || r.size != 0;
  if (placed && r.points)
    fail_usage("Points stay in the frame and unit of the capture; leave size, unit scale and origin out.");
  if (r.out.empty() || std::any_of(r.out.begin(), r.out.end(), holds_placed_object)) return;
  const std::string kind = r.out.front().extension().string();
  if (placed)
    fail_usage("A {} has no place for size, unit scale or origin; write .glb, .gltf, .obj, .usdz or .ply.",
               kind);
  if (r.light)
    fail_usage("The light is written beside a .glb, .gltf, .obj, .usdz or .ply; a {} holds it already.",
               kind);
}

void check_request(const ExportRequest& r, const fs::path& out) {
  const std::string kind = out.extension().string();
  if (!has(kind, {".glb", ".gltf", ".obj", ".usdz", ".ply", ".html", ".hdr", ".exr", ".npy", ".json"}))
    fail_usage(
        "{}: the ending says what to write: .glb, .gltf, .obj, .usdz or .ply for the object, .html for a "
        "page that shows it, .hdr, .exr, .npy or .json for its light.",
        out.string());
  if (r.points && kind != ".ply") fail_usage("Points are written as .ply, not {}.", kind);
  if (has(kind, {".ply", ".html"}) && r.texture.value_or(0) > 0)
    fail_usage("A {} has its colors at the vertices; for a texture write .glb, .gltf, .obj or .usdz.", kind);
  if (has(kind, {".gltf", ".obj", ".usdz"}) && r.texture == 0)
    fail_usage("A {} is written with a texture; without one write .glb or .ply.", kind);
  if (r.image == ExportImage::webp && !has(kind, {".glb", ".gltf"}))
    fail_usage("Only .glb and .gltf have WebP pictures, not {}.", kind);
  require_writable(out);
}

// Rows of Blender's and the program's own maps: of a capture that is y-up, row 0 is +Y.
Image environment_of(const Scene& scene) {
  constexpr int kHeight = 512;
  const EnvUp up = std::abs(normalize(scene.up).y) > 0.9 ? EnvUp::y : EnvUp::z;
  return env_resample(lat_long(scene.light, 2 * kHeight, up), kHeight);
}

std::string light_json(const SgMixture& light) {
  Json lobes = Json::array();
  for (const SgLobe& l : light.lobes)
    lobes.push_back({{"axis", {l.axis.x, l.axis.y, l.axis.z}},
                     {"sharpness", l.lambda},
                     {"radiance", {l.mu.x, l.mu.y, l.mu.z}}});
  return Json{
      {"meaning",
       "radiance from direction w: the sum over lobes of radiance exp(sharpness (w . axis - 1)), linear RGB; "
       "axes point to the light, in the frame of the capture"},
      {"lobes", lobes}}
      .dump(1);
}

void place(Mesh& mesh, const Placement& placement) {
  for (Vec3f& p : mesh.positions) p = to_float(placement(to_double(p)));
  for (Vec3f& n : mesh.normals) n = to_float(placement.turned(to_double(n)));
}

std::vector<FileBytes> asset_files(const MadeAsset& made, const fs::path& out, const std::string& kind,
                                   bool in_capture_frame) {
  if (kind == ".gltf") return gltf_files(made.asset, out);
  if (kind == ".obj") return obj_files(made.asset, made.textures, out, in_capture_frame);
  return {{out, kind == ".usdz" ? encode_usdz(made.asset) : encode_glb(made.asset)}};
}

// Scene in, files and reports out. What several files need is made once.
class Exporter {
 public:
  // seen_from: where the first photograph was taken, capture frame.
  Exporter(const Device& device, const Scene& scene, RenderCache& frames, Vec3d seen_from,
           const ExportRequest& request, Progress& progress)
      : device_(device),
        scene_(scene),
        frames_(frames),
        seen_from_(seen_from),
        request_(request),
        progress_(progress),
        preset_(preset_of(request.purpose)) {}

  ExportReport make(const fs::path& out) {
    ExportReport report;
    report.out = out;
    for (FileBytes& file : files_of(report)) {
      report.files.push_back(file.path);
      const auto same = [&](const FileBytes& f) { return f.path == file.path; };
      if (std::none_of(files_.begin(), files_.end(), same)) files_.push_back(std::move(file));
    }
    return report;
  }
  const std::vector<FileBytes>& files() const { return files_; }

 private:
  std::vector<FileBytes> files_of(ExportReport& report) {
    const std::string kind = report.out.extension().string();
    if (has(kind, {".hdr", ".exr", ".npy", ".json"})) {
      report.lobes = scene_.light.lobes.size();
      return {light_file(report.out, kind)};
    }
    if (kind == ".html") return {{report.out, page(report)}};
    std::vector<FileBytes> out =
        kind == ".ply" || request_.texture == 0 ? plain(report, kind) : textured(report, kind);
    if (request_.light) out.push_back(light_file(beside(report.out, ".env.hdr"), ".hdr"));
    return out;
  }

  PlacementOptions placement() const {
    return {request_.at_base.value_or(preset_.at_base) ? Origin::base : Origin::input, request_.unit_scale,
            request_.size};
  }

  const Image& environment() {
    if (environment_.empty()) environment_ = environment_of(scene_);
    return environment_;
  }

  FileBytes light_file(const fs::path& path, const std::string& kind) {
    if (kind == ".hdr") return {path, encode_hdr(environment())};
    if (kind == ".exr") return {path, encode_exr(environment())};
    if (kind == ".json") return {path, light_json(scene_.light)};
    return {path, encode_npy(to_array(scene_.light), int64_t(scene_.light.lobes.size()), 7)};
  }

  std::string page(ExportReport& report) {
    const ViewMesh mesh = view_mesh(scene_, size_t(request_.faces.value_or(preset_.page_faces)));
    report.vertices = mesh.vertices.size();
    report.triangles = mesh.triangles.size();
    report.simplification_error = mesh.error;
    progress_.report({"light", 0.2, -1, ""});
    const SceneLight light = frames_.light(scene_);
    const Appearance look = appearance_at(device_, scene_, vertex_hits(scene_.surface->mesh()));
    progress_.report({"reflections", 0.4, -1, ""});
    const Lighting lighting(device_, scene_.surface, scene_.light, light.vertices());
    const Vec3d from = seen_from_ - scene_.normalization.center;
    return object_page(
        report.out.stem().string(),
        {{"up", {scene_.up.x, scene_.up.y, scene_.up.z}}, {"from", {from.x, from.y, from.z}}},
        {{"tables", view_tables()},
         {"light", view_light(device_, scene_.light)},
         {"shape", view_shape(scene_, mesh)},
         {"look", view_look(scene_, mesh, look)},
         {"vertex_light", view_vertex_light(light.vertices(), mesh)},
         {"reflections", view_reflections(reflection_fits(lighting, *scene_.surface, mesh, look))}});
  }

  std::vector<FileBytes> handlers(ExportReport& report) const {
    const HandlerCloud cloud = handler_cloud(device_, scene_);
    report.vertices = cloud.points.positions.size();
    return {{report.out, encode_handlers(cloud)}};
  }

  // Colors at the vertices.
  std::vector<FileBytes> plain(ExportReport& report, const std::string& kind) const {
    if (request_.points) return handlers(report);
    auto [mesh, materials, error] = colored_mesh(device_, scene_, size_t(request_.faces.value_or(0)));
    if (request_.faces) report.simplification_error = error;
    report.vertices = mesh.positions.size();
    report.triangles = mesh.triangles.size();
    const Placement there = placement_of(mesh.positions, scene_.up, placement());
    if (kind != ".ply") return {{report.out, encode_glb(mesh, materials, there)}};
    if (!placement_is_input()) place(mesh, there);
    return {{report.out, encode_ply(mesh)}};
  }

  std::vector<FileBytes> textured(ExportReport& report, const std::string& kind) {
    const int texture = request_.texture.value_or(preset_.texture);
    if (!made_) {
      const AssetOptions options{.faces = size_t(request_.faces.value_or(preset_.faces)),
                                 .texture = texture,
                                 .pictures = picture_kind(request_.image.value_or(preset_.image)),
                                 .placement = placement()};
      made_ = make_asset(device_, scene_, beside(report.out, "").filename().string(), options, progress_);
    }
    report.vertices = made_->report.vertices;
    report.triangles = made_->report.triangles;
    report.texture = texture;
    report.charts = made_->report.charts;
    report.used = made_->report.atlas.used;
    report.stretch = made_->report.atlas.stretch;
    report.flipped = made_->report.atlas.flipped;
    report.overlapping = made_->report.atlas.overlapping;
    report.simplification_error = made_->report.error;
    return asset_files(*made_, report.out, kind, placement_is_input());
  }

  bool placement_is_input() const {
    const PlacementOptions p = placement();
    return p.origin == Origin::input && p.unit_scale == 1 && p.size == 0;
  }

  const Device& device_;
  const Scene& scene_;
  RenderCache& frames_;
  Vec3d seen_from_;
  const ExportRequest& request_;
  Progress& progress_;
  Preset preset_;
  std::optional<MadeAsset> made_;
  Image environment_;
  std::vector<FileBytes> files_;
};

}  // namespace

std::vector<ExportReport> Session::export_to(const ExportRequest& request, Progress& progress) {
  return threads_->run([&]() -> std::vector<ExportReport> {
    for (const fs::path& out : request.out) check_request(request, out);
    check_sizes(request);
    check_use(request);
    const Scene scene = project().scene();
    const std::vector<View>& views = project().capture().views;
    const Vec3d seen_from = views.empty()
                                ? scene.normalization.center + Vec3d{1, 1, 1} / scene.normalization.scale
                                : views.front().camera.center;
    Exporter exporter(*device_, scene, *frames_, seen_from, request, progress);
    std::vector<ExportReport> reports;
    for (const fs::path& out : request.out) reports.push_back(exporter.make(out));
    write_files_atomic(exporter.files());
    progress.report({"export", 1, 0, ""});
    return reports;
  });
}

}  // namespace cei3d
