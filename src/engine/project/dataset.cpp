// SPDX-License-Identifier: Apache-2.0
#include "engine/project/dataset.h"

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "core/base/json_reader.h"
#include "engine/capture/capture.h"
#include "model/geometry/shape/camera_json.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

std::string relative_to(const fs::path& file, const fs::path& root) {
  return file.empty() ? std::string()
                      : fs::absolute(file).lexically_normal().lexically_proximate(root).generic_string();
}

fs::path below(const fs::path& root, const std::string& file) {
  return file.empty() ? fs::path() : (root / file).lexically_normal();  // an absolute file stays absolute
}

// Present folder of the capture: the stored absolute path, or the stored relative path if both folders were
// moved together.
fs::path find_root(JsonReader& reader, const fs::path& project) {
  const fs::path root = reader.require<std::string>("root");
  const fs::path from_project = reader.require<std::string>("root_from_project");
  std::error_code error;
  if (fs::exists(root, error)) return root;
  const fs::path moved = fs::absolute(project / from_project).lexically_normal();
  return fs::exists(moved, error) ? moved : root;
}

Split split_of(const std::string& name) {
  const std::optional<Split> split = split_from_name(name);
  if (!split) fail("The project's dataset.json names the unknown split '{}'. Restore it from a copy.", name);
  return *split;
}

uintmax_t size_of(const fs::path& file) {
  std::error_code error;
  const uintmax_t size = file.empty() ? 0 : fs::file_size(file, error);
  return error ? 0 : size;
}

Json photo_json(const PhotoCamera& photo) {
  const LensDistortion& lens = photo.lens();
  return {{"camera", camera_json(photo.camera())},
          {"lens", lens.kind == LensKind::fisheye ? "fisheye" : "perspective"},
          {"radial", lens.radial},
          {"divisor", lens.divisor},
          {"tangential", {lens.p1, lens.p2}}};
}

PhotoCamera photo_from_json(JsonReader reader) {
  JsonReader camera = reader.object("camera");
  const Camera k = camera_from_json(camera);
  camera.finish();
  LensDistortion lens;
  const auto kind = reader.require<std::string>("lens");
  if (kind != "fisheye" && kind != "perspective")
    fail("{} has the unknown lens '{}'; restore it from a copy.", reader.what(), kind);
  lens.kind = kind == "fisheye" ? LensKind::fisheye : LensKind::perspective;
  lens.radial = reader.numbers<4>("radial");
  lens.divisor = reader.numbers<3>("divisor");
  const auto [p1, p2] = reader.numbers<2>("tangential");
  lens.p1 = p1, lens.p2 = p2;
  reader.finish();
  return {k, lens};
}

// What only some views have is left out where they do not.
Json view_json(const View& v, const fs::path& root, const fs::path& project) {
  Json j{{"name", v.name},
         {"split", split_name(v.split)},
         {"image", relative_to(v.image_path, root)},
         {"mask", relative_to(v.mask_path, root)},
         {"camera", camera_json(v.camera)}};
  if (v.dark_object) j["dark_object"] = true;
  if (!v.doubtful_path.empty()) j["doubtful"] = relative_to(v.doubtful_path, project);
  if (v.photo) j["photo"] = photo_json(*v.photo);
  return j;
}

}  // namespace

Json dataset_json(const Capture& capture, const fs::path& project) {
  const fs::path root = fs::absolute(capture.root).lexically_normal();
  const fs::path home = fs::absolute(project).lexically_normal();
  Json views = Json::array();
  for (const View& v : capture.views) views.push_back(view_json(v, root, home));
  return {{"format", capture.format},
          {"root", root.generic_string()},
          {"root_from_project", root.lexically_proximate(home).generic_string()},
          {"fingerprint", capture_fingerprint(capture)},
          {"up", vector_json(capture.up)},
          {"views", std::move(views)}};
}

namespace {

View view_from_json(JsonReader reader, const fs::path& root, const fs::path& project) {
  View view;
  view.name = reader.require<std::string>("name");
  view.split = split_of(reader.require<std::string>("split"));
  JsonReader camera = reader.object("camera");
  view.camera = camera_from_json(camera);
  camera.finish();
  view.image_path = below(root, reader.require<std::string>("image"));
  view.mask_path = below(root, reader.require<std::string>("mask"));
  view.dark_object = reader.optional("dark_object", false);
  view.doubtful_path = below(project, reader.optional<std::string>("doubtful", ""));
  if (reader.has("photo")) view.photo = photo_from_json(reader.object("photo"));
  reader.finish();
  return view;
}

}  // namespace

Dataset dataset_from_json(const Json& j, const fs::path& project) {
  const std::string file = (project / "dataset.json").string();
  JsonReader reader(j, file);
  Dataset d;
  Capture& c = d.capture;
  c.root = find_root(reader, project);
  c.format = reader.require<std::string>("format");
  c.up = vector_from(reader, "up");
  for (const Json& v : reader.array("views"))
    c.views.push_back(view_from_json({v, "A view in " + file}, c.root, project));
  d.fingerprint = reader.require<std::string>("fingerprint");
  reader.finish();
  return d;
}

std::string capture_fingerprint(const Capture& capture) {
  std::string text = capture.format;
  for (const View& v : capture.views) {
    text += fmt::format("\n{} {} {} {} {}", v.name, split_name(v.split), size_of(v.image_path),
                        size_of(v.mask_path), camera_json(v.camera).dump());
    if (v.dark_object) text += " dark";
    if (v.photo) text += fmt::format(" {}", photo_json(*v.photo).dump());
  }
  return content_hash(text);
}

}  // namespace cei3d
