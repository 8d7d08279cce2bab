// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/colmap_model.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

using Folders = std::vector<fs::path>;

Folders models_in(const fs::path& folder) {
  Folders models;
  std::error_code error;
  if (is_colmap_model(folder)) models.push_back(folder);
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_directory(error) && is_colmap_model(entry.path())) models.push_back(entry.path());
  std::sort(models.begin(), models.end());
  return models;
}

// The models of the first place that has one.
Folders models_of(const fs::path& path) {
  if (fs::is_regular_file(path)) {
    const std::string stem = path.stem().string(), suffix = path.extension().string();
    const bool of_model = (stem == "cameras" || stem == "images" || stem == "points3D") &&
                          (suffix == ".bin" || suffix == ".txt");
    return of_model && is_colmap_model(path.parent_path()) ? Folders{path.parent_path()} : Folders();
  }
  if (is_colmap_model(path)) return {path};
  for (const char* place : {"sparse", "colmap/sparse", "dense/sparse", "dense/0/sparse", "colmap", "."})
    if (const Folders models = models_in(path / place); !models.empty()) return models;
  return {};
}

fs::path largest(const Folders& models, Capture& capture) {
  std::vector<size_t> counts;
  size_t all = 0;
  for (const fs::path& model : models) counts.push_back(colmap_image_count(model)), all += counts.back();
  const auto best = std::max_element(counts.begin(), counts.end());
  const fs::path& model = models[size_t(best - counts.begin())];
  if (models.size() > 1)
    capture.warnings.push_back(fmt::format(
        "There are {} models; {} has most images ({} of {}) and is used. The images of the others are not.",
        models.size(), model.string(), *best, all));
  return model;
}

// The folder that the images' names start from, and the folder of the capture.
struct Place {
  fs::path images, root;
};
Place place_of(const fs::path& model, const ColmapModel& m) {
  const fs::path start = fs::absolute(model).lexically_normal();
  fs::path base = start;
  for (int up = 0; up < 4 && base != base.root_path(); ++up, base = base.parent_path())
    for (const char* name : {"images", "image", "input", "rgb", "images_2", "images_4", "images_8", "."})
      for (size_t i = 0; i < m.images.size(); i += std::max<size_t>(1, m.images.size() / 8))
        if (const fs::path folder = (base / name).lexically_normal(); fs::exists(folder / m.images[i].name))
          return {folder, base};
  const fs::path root =
      start.parent_path().filename() == "sparse" ? start.parent_path().parent_path() : start;
  return {root / "images", root};
}

View view_of(const ColmapImage& image, const ColmapModel& m, const Place& place, const std::string& where) {
  const auto camera = m.cameras.find(image.camera);
  if (camera == m.cameras.end()) fail("{} names camera {}, which is not in the model.", where, image.camera);
  View view;
  view.name = view_name(image.name, Split::train);
  view.image_path = own_file(place.root, place.images / image.name, where);
  view.camera = camera->second.k;
  view.camera.world_from_cam = transpose(image.cam_from_world);
  view.camera.center = -(view.camera.world_from_cam * image.translation);
  if (distorts(camera->second.lens)) view.photo = PhotoCamera(view.camera, camera->second.lens);
  auto sightings = std::make_shared<std::vector<Sighting>>();
  for (const ColmapImage::Point& p : image.points)
    if (const auto point = m.points.find(p.id); point != m.points.end())
      sightings->push_back({point->second, p.pixel});
  if (!sightings->empty()) view.sightings = std::move(sightings);
  return view;
}

}  // namespace

bool detect_colmap(const fs::path& path) { return !models_of(path).empty(); }

Capture load_colmap(const fs::path& path) {
  Capture capture;
  capture.format = "colmap";
  const fs::path folder = largest(models_of(path), capture);
  const ColmapModel model = read_colmap_model(folder);
  const Place place = place_of(folder, model);
  capture.root = place.root;
  for (const ColmapImage& image : model.images)
    capture.views.push_back(
        view_of(image, model, place, fmt::format("Image {} of {}", image.name, folder.string())));
  return capture;
}

}  // namespace cei3d
