// SPDX-License-Identifier: Apache-2.0
// A capture: cameras, files and splits, in the capture frame.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"
#include "core/math/lens.h"

namespace cei3d {

enum class Split { train, val, test };

// A point of the object or its surroundings, and where the photograph shows it, as the capture says.
struct Sighting {
  Vec3d point;  // capture frame
  Vec2d pixel;  // of the photograph; pixel centers at +0.5
};

struct View {
  std::string name;  // "train/r_055": split folder and stem, unique in the capture
  Split split = Split::train;
  Camera camera;                     // capture frame; pixel centers at +0.5
  std::filesystem::path image_path;  // empty: a camera without a photograph
  std::filesystem::path mask_path;   // empty: the mask is the alpha of the image
  bool dark_object = false;          // mask or alpha mean the background, not the object
  // PNG of the size of `camera`, white where the mask contradicts the other views: nothing is known there.
  // Empty: nowhere.
  std::filesystem::path doubtful_path;
  // The camera that took the photograph, where its pixels are not those of `camera`: it has a lens, and
  // `camera` is a pinhole camera of the same pose that frames the object. Images are resampled when they are
  // loaded.
  std::optional<PhotoCamera> photo;
  std::shared_ptr<const std::vector<Sighting>> sightings;  // null: the capture has none

  // The camera of the files: of the photograph, its mask, and what a user draws or clicks on it.
  const Camera& file_camera() const { return photo ? photo->camera() : camera; }
};

// Where a view was really taken from, as a reconstruction found out; capture frame.
struct RefinedPose {
  std::string view;  // its name
  Mat3d world_from_cam;
  Vec3d center;
};

// What a reconstruction found out about the cameras of a capture.
struct RefinedCameras {
  std::vector<RefinedPose> poses;  // of training views; empty: those of the capture are right
  double focal = 1;                // factor on the focal lengths of all views, the held-out ones, too
};

// How much brighter a photograph is than the others, as a reconstruction found out.
struct ViewExposure {
  std::string view;        // its name
  Vec3f factors{1, 1, 1};  // of the linear channels; the geometric mean over the views is 1
};

// A ball that contains the object, as some formats state it.
struct ObjectBall {
  Vec3d center;
  double radius;
};

struct Capture {
  std::filesystem::path root;
  std::string format;                 // one of capture_format_names()
  std::vector<View> views;            // train first, then val, test; each in the order of the capture
  std::optional<ObjectBall> region;   // capture frame
  Vec3d up{0, 0, 1};                  // axis that points up, capture frame
  std::vector<std::string> warnings;  // one sentence per assumption that the loader made
};

// The capture with these focal lengths, and with the poses of the views that are named; other names are
// passed over. Photographs are resampled as before.
Capture with_cameras(Capture, const RefinedCameras&);

// What an image file can hold.
enum class ImageDepth {
  bits8,   // 256 steps of the display curve up to 1
  bits16,  // finer steps up to 1
  open     // linear radiance without an upper limit
};

// Loads the image of a view. An interface, because reading files is up to engine/capture (CaptureImages).
// Called from several threads.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  // RGBA, linear, straight alpha; alpha is the object mask, below 0 where it is not known what the view shows
  virtual Image load(const View&) const = 0;
  virtual ImageDepth depth(const View&) const { return ImageDepth::bits8; }
  // How much light reached the sensor, times its gain, by the camera's notes, relative to other views; none:
  // nothing was noted.
  virtual std::optional<double> exposure(const View&) const { return std::nullopt; }
};

// Alpha of pixels that show nothing known: neither object nor background.
inline constexpr float kUnknownAlpha = -1;

}  // namespace cei3d
