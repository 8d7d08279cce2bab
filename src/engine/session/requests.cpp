// SPDX-License-Identifier: Apache-2.0
#include "engine/session/requests.h"

#include <iterator>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/capture/coverage.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

constexpr const char* kChannels[] = {"rgb",   "albedo",    "diffuse",   "specular", "normal",
                                     "depth", "roughness", "metalness", "mask"};
constexpr const char* kSeverities[] = {"note", "warning", "error"};
constexpr const char* kTargets[] = {"albedo", "appearance", "radiance"};
constexpr const char* kRoutings[] = {"both", "points", "outline", "none"};
constexpr const char* kViewOrders[] = {"informative", "adjacent"};
constexpr const char* kMaskCombinations[] = {"votes", "any"};
constexpr const char* kConventions[] = {"", "zup", "yup", "mitsuba", "blender"};

template <class Enum, size_t N>
std::optional<Enum> from_name(const char* const (&names)[N], const std::string& name) {
  for (size_t i = 0; i < N; ++i)
    if (name == names[i] && *names[i]) return Enum(i);
  return std::nullopt;
}

Json normalization_json(const Normalization& n) {
  return {{"center", vector_json(n.center)}, {"scale", n.scale}};
}

Json seen_json(const SeenSides& s) {
  return {{"share", s.share}, {"gap", s.gap}, {"unseen", vector_json(s.unseen)}};
}

Json material_json(const Material& m) {
  return {{"roughness", m.roughness}, {"specular", m.specular}, {"metalness", m.metalness}};
}

}  // namespace

const char* channel_name(Channel c) { return kChannels[size_t(c)]; }
std::optional<Channel> channel_from_name(const std::string& name) {
  return from_name<Channel>(kChannels, name);
}
const char* paint_target_name(PaintTarget t) { return kTargets[size_t(t)]; }
const char* routing_name(Routing r) { return kRoutings[size_t(r)]; }
std::optional<PaintTarget> paint_target_from_name(const std::string& name) {
  return from_name<PaintTarget>(kTargets, name);
}
std::optional<Routing> routing_from_name(const std::string& name) {
  return from_name<Routing>(kRoutings, name);
}
std::optional<ViewOrder> view_order_from_name(const std::string& name) {
  return from_name<ViewOrder>(kViewOrders, name);
}
std::optional<MaskCombination> mask_combination_from_name(const std::string& name) {
  return from_name<MaskCombination>(kMaskCombinations, name);
}
std::optional<EnvConvention> env_convention_from_name(const std::string& name) {
  return from_name<EnvConvention>(kConventions, name);
}

CaptureOptions capture_options(const std::string& format, const ReconstructOptions& o) {
  return {format, o.test_every, o.views, false, o.test_share, o.seed};
}

Json MachineInfo::json() const {
  return {{"program", program},
          {"processor", processor},
          {"cores", cores},
          {"memory_gib", memory_gib},
          {"devices", devices}};
}

Json CheckReport::json() const {
  Json splits = Json::object(), findings = Json::array();
  for (const SplitReport& r : report.splits)
    splits[split_name(r.split)] = {
        {"views", r.views},
        {"size", {r.size.width, r.size.height}},
        {"sizes_vary", r.sizes_vary},
        {"coverage", {{"mean", r.coverage}, {"least", r.coverage_min}, {"most", r.coverage_max}}}};
  for (const Finding& f : report.findings)
    findings.push_back({{"severity", kSeverities[size_t(f.severity)]},
                        {"what", f.what},
                        {"fix", f.fix},
                        {"views", f.views}});
  return {
      {"format", report.format},
      {"root", capture.root.string()},
      {"splits", splits},
      {"up", vector_json(report.up)},
      {"normalization", report.normalization ? normalization_json(*report.normalization) : Json()},
      {"object_radius", object_radius},
      {"camera_distance",
       {{"least", report.distance_min}, {"mean", report.distance}, {"most", report.distance_max}}},
      {"seen", report.normalization ? seen_json(seen_sides(capture, report.normalization->center)) : Json()},
      {"findings", findings},
      {"repaired", repaired},
      {"usable", report.usable()}};
}

Json ObjectSummary::json() const {
  Json j = material_json(mean);
  j["varies"] = varies;
  j["metal_share"] = metal_share;
  j["roughness_range"] = {min_roughness, max_roughness};
  j["light"] = {{"motion", light_motion_name(light_motion)}};
  if (light_error) j["light"]["relative_error"] = {light_error->x, light_error->y, light_error->z};
  j["refined_poses"] = refined_poses;
  j["focal"] = focal;
  j["exposures"] = exposures;
  if (explained)
    j["explained_db"] = {{"physical", explained->physical}, {"with_residual", explained->with_residual}};
  return j;
}

std::string ObjectSummary::text() const {
  std::string text = material_text() + "; " + light_text();
  if (refined_poses > 0) text += fmt::format("; the poses of {} views were refined", refined_poses);
  if (focal != 1) text += fmt::format("; the focal length was changed by {:+.1f} %", 100 * (focal - 1));
  if (exposures > 0)
    text +=
        fmt::format("; exposures that differ by {:.0f} % were made equal", 100 * (std::exp(exposures) - 1));
  return text;
}

std::string ObjectSummary::material_text() const {
  if (!varies)
    return fmt::format("roughness {:.2f}, {}", mean.roughness,
                       mean.metalness > 0.5f ? "metal" : "dielectric");
  return fmt::format("several materials: roughness {:.2f} to {:.2f}, {:.0f} % metal", min_roughness,
                     max_roughness, 100 * metal_share);
}

std::string ObjectSummary::light_text() const {
  const std::string motion = light_motion == LightMotion::world    ? "light that stands still"
                             : light_motion == LightMotion::camera ? "light that moves with the camera"
                                                                   : "light that turns, as on a turntable";
  if (!light_error) return motion + ", its strength assumed";
  return fmt::format("{}, its strength, and with it the albedo, known to {:.0f} %", motion,
                     100 * max(light_error->x, max(light_error->y, light_error->z)));
}

std::string ObjectSummary::warning() const {
  constexpr double kMuchLess = 1.5, kBad = 22;  // dB
  if (!explained) return {};
  if (explained->with_residual < kBad)
    return fmt::format(
        "The object explains its photographs to {:.1f} dB only: look at its pictures, and at what a check of "
        "the capture says about poses and masks.",
        explained->with_residual);
  if (explained->with_residual - explained->physical < kMuchLess) return {};
  return fmt::format(
      "Light and material explain the photographs to {:.1f} dB, with the correction {:.1f} dB: edits and "
      "other light will look less realistic than the object as photographed.",
      explained->physical, explained->with_residual);
}

Json ReconstructReport::json() const {
  return {{"seconds", seconds},     {"views", views},
          {"downscale", downscale}, {"handler_points", handler_points},
          {"vertices", vertices},   {"material", object.json()}};
}

Json ProjectInfo::json() const {
  Json j = {{"folder", folder.string()},
            {"capture", {{"root", capture_root.string()}, {"format", capture_format}}},
            {"views", {{"train", views[0]}, {"val", views[1]}, {"test", views[2]}}},
            {"normalization", normalization_json(normalization)},
            {"options", options},
            {"finished", finished},
            {"bytes", bytes}};
  if (finished)
    j["object"] = {{"material", object.json()},
                   {"vertices", vertices},
                   {"triangles", triangles},
                   {"handler_points", handler_points},
                   {"handler_spacing", handler_spacing},
                   {"lobes", lobes},
                   {"edits", edits},
                   {"edits_active", edits_active}};
  return j;
}

Json LogEntry::json() const {
  Json j = {{"id", id},     {"op", op},         {"enabled", enabled},
            {"done", done}, {"params", params}, {"report", report}};
  if (!name.empty()) j["name"] = name;
  if (set_aside) j["set_aside"] = true;
  return j;
}

std::string InputFile::read() const { return bytes ? *bytes : read_file(path); }

Json EditSummary::json() const {
  Json j = {{"id", id}};
  j.update(report);
  j["seconds"]["load"] = load_seconds;
  j["seconds"]["store"] = store_seconds;
  return j;
}

Json ChangeSummary::json() const {
  return {{"view", view},
          {"pixels_inside", pixels_inside},
          {"pixels_changed", pixels_changed},
          {"changed_outside", changed_outside}};
}

Json ReplayReport::json() const {
  Json list = Json::array();
  for (const auto& [from, to] : edits) list.push_back({{"from", from}, {"to", to}});
  return {{"edits", list}, {"notes", notes}};
}

Json RenderReport::json() const {
  Json list = Json::array();
  for (const auto& f : folders) list.push_back(f.string());
  return {{"views", views},
          {"seconds", seconds},
          {"trace_seconds", trace_seconds},
          {"shade_seconds", shade_seconds},
          {"folders", list}};
}

Json PartInfo::json() const { return {{"name", name}, {"edit", edit}, {"points", points}, {"share", share}}; }

Json PartMasksReport::json() const { return {{"views", views}, {"shown", shown}, {"seconds", seconds}}; }

bool holds_placed_object(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  return kind == ".glb" || kind == ".gltf" || kind == ".obj" || kind == ".usdz" || kind == ".ply";
}

std::optional<ExportFor> export_for_from_name(const std::string& name) {
  if (name == "web") return ExportFor::web;
  if (name == "ar") return ExportFor::ar;
  if (name == "dcc") return ExportFor::dcc;
  return std::nullopt;
}

std::optional<ExportImage> export_image_from_name(const std::string& name) {
  if (name == "png") return ExportImage::png;
  if (name == "jpeg") return ExportImage::jpeg;
  if (name == "webp") return ExportImage::webp;
  return std::nullopt;
}

Json ExportReport::json() const {
  Json j{{"file", out.string()}, {"vertices", vertices}, {"triangles", triangles}, {"lobes", lobes}};
  for (const auto& f : files) j["files"].push_back(f.string());
  if (texture > 0) {
    j["texture"] = {{"size", texture},    {"charts", charts},   {"used", used},
                    {"stretch", stretch}, {"flipped", flipped}, {"overlapping", overlapping}};
  }
  if (simplification_error) j["simplification_error"] = *simplification_error;
  return j;
}

}  // namespace cei3d
