// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/capture_photos.h"

#include <algorithm>
#include <set>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/system.h"
#include "engine/capture/capture.h"
#include "engine/io/image_file.h"
#include "engine/photos/colmap_run.h"
#include "engine/photos/object_masks.h"
#include "engine/photos/photo_files.h"
#include "engine/photos/photo_segmenter.h"
#include "engine/photos/still_pixels.h"
#include "engine/segment/sam.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Shares of the progress at which the steps end.
constexpr double kCopied = 0.02, kPosed = 0.6;

// What is there before anything takes long.
std::unique_ptr<PhotoSegmenter> segmenter_of(const PhotosRequest& r) {
  if (!r.masks) return nullptr;
  if (!r.plate.empty()) return plate_segmenter(r.plate);
  try {
    return sam_segmenter(installed_sam(), r.threads);
  } catch (const Error& e) {
    throw Error(e.code(), e.what(),
                "`./run sam` installs the network that finds the object. Without it: a photograph of the "
                "background alone, or poses only (no masks).");
  }
}

std::vector<fs::path> paths_of(const PhotoFiles& photos, const fs::path& folder) {
  std::vector<fs::path> out;
  for (const std::string& name : photos.names) out.push_back(folder / name);
  return out;
}

// Files that keep COLMAP from finding features on what stands still while the object turns. Where the camera
// went around the object, only plain background is the same in nearly all photographs, which has no features.
// Photographs of several cameras or sizes: none.
fs::path write_feature_masks(const PhotosRequest& r, const PhotoFiles& photos, const Progress& progress) {
  const fs::path folder = r.out / "work/features";
  if (!r.turntable && !photos.one_camera) return {};
  const StillPixels still = still_pixels(paths_of(photos, r.out / "images"), progress);
  Image mask(still.width, still.height, 1);
  const int columns = still.width / still.reduction, rows = still.height / still.reduction;
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      const int i = std::min(x / still.reduction, columns - 1), j = std::min(y / still.reduction, rows - 1);
      *mask.at(x, y) = still.area[size_t(j) * columns + i] ? 0.0f : 1.0f;
    }
  for (const std::string& name : photos.names) write_png(folder / (name + ".png"), mask);
  return folder;
}

std::vector<std::string> missing_views(const PhotoFiles& photos, const Capture& capture) {
  std::set<std::string> posed;
  for (const View& v : capture.views) posed.insert(v.image_path.filename().string());
  std::vector<std::string> out;
  for (const std::string& name : photos.names)
    if (!posed.contains(name)) out.push_back(name);
  return out;
}

std::vector<PhotoClick> clicks_of(const PhotosRequest& r, const Capture& capture) {
  std::vector<PhotoClick> out;
  for (const PhotosRequest::Click& c : r.clicks) {
    const View& v = find_view(capture, c.photo);
    const Camera& k = v.file_camera();
    if (!(c.pixel.x >= 0 && c.pixel.y >= 0 && c.pixel.x < k.width && c.pixel.y < k.height))
      fail_usage("The click {},{} is outside of {}, which is {} x {}.", c.pixel.x, c.pixel.y, c.photo,
                 k.width, k.height);
    out.push_back({size_t(&v - capture.views.data()), {float(c.pixel.x), float(c.pixel.y)}, c.object});
  }
  return out;
}

// The right to write the folder, after a look at what is in it. Errors: another process writes there; it was
// begun with other photographs, or holds something else.
FileLock claim(const PhotosRequest& r) {
  const fs::path note = r.out / "work/photographs";
  const std::string from = fs::absolute(r.photos).lexically_normal().string();
  const auto lock = [&] {
    std::optional<FileLock> taken = FileLock::take(r.out / "work/lock");
    if (!taken) fail("Another process is writing {}.", r.out.string());
    return std::move(*taken);
  };
  if (fs::exists(note)) {
    if (read_file(note) == from) return lock();
    throw Error(ErrorCode::usage,
                fmt::format("{} was begun with the photographs {}.", r.out.string(), read_file(note)),
                "Name another folder after -o, or remove that one.");
  }
  if (fs::exists(r.out) && !fs::is_empty(r.out))
    fail_usage("{} is not empty. Name a new folder after -o.", r.out.string());
  write_file_atomic(note, from);
  return lock();
}

// Masks by other clicks or another plate are moved aside, so that new ones are made.
void set_aside_other_masks(const PhotosRequest& r) {
  std::string prompts = r.plate.string() + "\n";
  for (const PhotosRequest::Click& c : r.clicks)
    prompts += fmt::format("{} {} {} {}\n", c.photo, c.pixel.x, c.pixel.y, c.object);
  const fs::path note = r.out / "work/prompts";
  if (fs::exists(note) && read_file(note) == prompts) return;
  fs::remove_all(r.out / "work/first_masks");
  if (fs::exists(r.out / "masks")) {
    fs::remove_all(r.out / "work/earlier_masks");
    move_path(r.out / "masks", r.out / "work/earlier_masks");
  }
  write_file_atomic(note, prompts);
}

}  // namespace

Json PhotosReport::json() const {
  return {
      {"capture", out.string()},      {"photos", photos},  {"posed", posed}, {"without_pose", without_pose},
      {"without_mask", without_mask}, {"seconds", seconds}};
}

PhotosReport capture_photos(const PhotosRequest& r, Progress& progress) {
  const double start = steady_seconds();
  require_colmap();
  const std::unique_ptr<PhotoSegmenter> segmenter = segmenter_of(r);
  const FileLock lock = claim(r);
  progress.report({"photographs", 0, -1, ""});
  const PhotoFiles photos = copy_photos(r.photos, r.out / "images", r.frames, progress);
  PosingRequest posing;
  posing.images = r.out / "images", posing.work = r.out / "work", posing.sparse = r.out / "sparse";
  posing.one_camera = photos.one_camera, posing.in_order = photos.in_order;
  posing.turntable = r.turntable, posing.focal = r.focal, posing.threads = r.threads;
  if (!poses_are_found(posing)) posing.feature_masks = write_feature_masks(r, photos, progress);
  find_poses(posing, kCopied, r.masks ? kPosed : 1, progress);

  const Capture capture = load_capture(r.out / "sparse", {"colmap"});
  PhotosReport report{r.out, photos.names.size(), capture.views.size(), missing_views(photos, capture), {},
                      0};
  if (2 * report.posed < report.photos)
    throw Error(
        ErrorCode::failed,
        fmt::format("COLMAP found the poses of only {} of {} photographs.", report.posed, report.photos),
        "More overlap between neighbors helps, and texture: docs/photographing.md.");
  if (segmenter) {
    set_aside_other_masks(r);
    MaskRequest masks{capture.views, clicks_of(r, capture), r.out / "work/first_masks", r.out / "masks"};
    report.without_mask = make_masks(masks, *segmenter, kPosed, 1, progress);
  }
  report.seconds = steady_seconds() - start;
  return report;
}

}  // namespace cei3d
