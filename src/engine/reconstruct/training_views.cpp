// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/training_views.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/cancel.h"
#include "engine/reconstruct/poses/align_views.h"
#include "engine/reconstruct/poses/refined_cameras.h"

namespace cei3d {

namespace {

constexpr int kRim = 6;             // pixels around the object that are trained on
constexpr size_t kMaxHeldOut = 8;   // held-out views that are read
constexpr double kMinNoted = 0.02;  // spread of noted exposures (exposure_change()) that counts

// The camera in the unit frame, for an image of this width (images may be downscaled).
Camera camera_of(const View& view, const Normalization& normalization, const Image& image) {
  Camera camera = normalization.unit_from_capture(view.camera);
  const double scale = double(image.width) / camera.width;
  camera.width = image.width;
  camera.height = image.height;
  for (double* f : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.skew}) *f *= scale;
  return camera;
}

std::vector<Vec3f> relative_exposures(const std::vector<std::optional<double>>& noted) {
  double mean = 0;
  for (const auto& e : noted) {
    if (!e || !(*e > 0)) return {};
    mean += std::log(*e) / double(noted.size());
  }
  std::vector<Vec3f> factors;
  for (const auto& e : noted) {
    const float factor = float(*e / std::exp(mean));
    factors.push_back({factor, factor, factor});
  }
  return exposure_change({}, factors) < kMinNoted ? std::vector<Vec3f>() : factors;
}

}  // namespace

void TrainingViews::set_cameras(const RefinedCameras& found, const Normalization& normalization) {
  train.set_cameras(refined(given_train, found, normalization));
  std::vector<Camera> others = given_held_out;
  for (Camera& c : others) c = zoomed(c, found.focal);
  held_out.set_cameras(std::move(others));
}

TrainingViews load_training_views(const Capture& capture, const ImageSource& images,
                                  const Normalization& normalization, Progress& progress) {
  TrainingViews v;
  std::vector<std::optional<double>> noted;
  int done = 0;
  for (const View& view : capture.views) {
    progress.report({"", double(done++) / double(capture.views.size()), -1, view.name});
    check_cancelled(progress);
    const bool train = view.split == Split::train;
    if (!train && v.held_out.cameras().size() >= kMaxHeldOut) continue;
    const Image image = images.load(view);
    const Camera camera = camera_of(view, normalization, image);
    (train ? v.train : v.held_out).add_view(camera, image, kRim, images.depth(view));
    if (!train) continue;
    v.footprint += length(camera.center) / camera.fx;
    noted.push_back(images.exposure(view));
  }
  v.footprint /= double(std::max<size_t>(noted.size(), 1));
  v.noted_exposures = relative_exposures(noted);
  v.given_train = v.train.cameras();
  v.given_held_out = v.held_out.cameras();
  if (v.train.pixels().empty()) fail("No training image shows the object: every mask is empty.");
  return v;
}

}  // namespace cei3d
