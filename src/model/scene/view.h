// SPDX-License-Identifier: Apache-2.0
// What a capture says: cameras, files and splits, in the capture's own frame ("input").
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"

namespace cei3d {

enum class Split { train, val, test };

struct View {
  std::string name;  // "train/r_055": split folder and stem, unique in the capture
  Split split = Split::train;
  Camera camera;                     // input frame; pixel centers at +0.5
  std::filesystem::path image_path;  // empty: a camera without a photograph
  std::filesystem::path mask_path;   // empty: alpha of the image is the mask
};

// A ball that holds the object, as some formats state it.
struct ObjectBall {
  Vec3d center;
  double radius;
};

struct Capture {
  std::filesystem::path root;
  std::string format;                 // "nerf-synthetic", "physg", "idr"
  std::vector<View> views;            // train first, then val, test; each sorted as the capture lists them
  std::optional<ObjectBall> region;   // input frame
  Vec3d up{0, 0, 1};                  // world axis that points to the sky, input frame
  std::vector<std::string> warnings;  // what the loader had to guess, one sentence each
};

// Pictures by view. Behind an interface because files are engine/io's business (CaptureImages there reads
// them). May be called from several threads.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  virtual Image load(const View&) const = 0;  // RGBA, linear, straight alpha; alpha is the object mask
};

}  // namespace cei3d
