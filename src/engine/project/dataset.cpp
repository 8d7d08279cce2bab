// SPDX-License-Identifier: Apache-2.0
#include "engine/project/dataset.h"

#include "core/base/error.h"
#include "core/base/hash.h"
#include "engine/capture/capture.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

Json vector_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }
Vec3d vector_from(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

std::string relative_to(const fs::path& file, const fs::path& root) {
  return file.empty() ? std::string()
                      : fs::absolute(file).lexically_normal().lexically_proximate(root).generic_string();
}

fs::path below(const fs::path& root, const std::string& file) {
  return file.empty() ? fs::path() : (root / file).lexically_normal();  // an absolute file stays absolute
}

// Where the capture is now: where it was, or where it lies relative to the project when both were moved
// together.
fs::path find_root(const Json& j, const fs::path& project) {
  const fs::path root = j.at("root").get<std::string>();
  std::error_code error;
  if (fs::exists(root, error)) return root;
  const fs::path moved =
      fs::absolute(project / j.at("root_from_project").get<std::string>()).lexically_normal();
  return fs::exists(moved, error) ? moved : root;
}

Json view_json(const View& v, const fs::path& root) {
  return {{"name", v.name},
          {"split", split_name(v.split)},
          {"image", relative_to(v.image_path, root)},
          {"mask", relative_to(v.mask_path, root)},
          {"camera", camera_json(v.camera)}};
}

Split split_of(const std::string& name) {
  const std::optional<Split> split = split_from_name(name);
  if (!split) fail("dataset.json of the project names the unknown split '{}'; restore it from a copy.", name);
  return *split;
}

uintmax_t size_of(const fs::path& file) {
  std::error_code error;
  const uintmax_t size = file.empty() ? 0 : fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

Json camera_json(const Camera& c) {
  Json rotation = Json::array();
  for (const Vec3d& row : c.world_from_cam.row) rotation.push_back(vector_json(row));
  return {{"width", c.width},
          {"height", c.height},
          {"fx", c.fx},
          {"fy", c.fy},
          {"cx", c.cx},
          {"cy", c.cy},
          {"skew", c.skew},
          {"world_from_cam", std::move(rotation)},
          {"center", vector_json(c.center)}};
}

Camera camera_from_json(const Json& j) {
  Camera c;
  c.width = j.at("width").get<int>();
  c.height = j.at("height").get<int>();
  c.fx = j.at("fx").get<double>();
  c.fy = j.at("fy").get<double>();
  c.cx = j.at("cx").get<double>();
  c.cy = j.at("cy").get<double>();
  c.skew = j.value("skew", 0.0);
  for (int i = 0; i < 3; ++i) c.world_from_cam.row[i] = vector_from(j.at("world_from_cam").at(size_t(i)));
  c.center = vector_from(j.at("center"));
  return c;
}

Json dataset_json(const Capture& capture, const fs::path& project) {
  const fs::path root = fs::absolute(capture.root).lexically_normal();
  const fs::path home = fs::absolute(project).lexically_normal();
  Json views = Json::array();
  for (const View& v : capture.views) views.push_back(view_json(v, root));
  return {{"format", capture.format},
          {"root", root.generic_string()},
          {"root_from_project", root.lexically_proximate(home).generic_string()},
          {"fingerprint", capture_fingerprint(capture)},
          {"up", vector_json(capture.up)},
          {"views", std::move(views)}};
}

Capture capture_from_json(const Json& j, const fs::path& project) {
  Capture c;
  c.root = find_root(j, project);
  c.format = j.at("format").get<std::string>();
  c.up = vector_from(j.at("up"));
  for (const Json& v : j.at("views")) {
    View view;
    view.name = v.at("name").get<std::string>();
    view.split = split_of(v.at("split").get<std::string>());
    view.camera = camera_from_json(v.at("camera"));
    view.image_path = below(c.root, v.at("image").get<std::string>());
    view.mask_path = below(c.root, v.at("mask").get<std::string>());
    c.views.push_back(std::move(view));
  }
  return c;
}

std::string capture_fingerprint(const Capture& capture) {
  std::string text = capture.format;
  for (const View& v : capture.views)
    text += fmt::format("\n{} {} {} {} {}", v.name, split_name(v.split), size_of(v.image_path),
                        size_of(v.mask_path), camera_json(v.camera).dump());
  return content_hash(text);
}

}  // namespace cei3d
