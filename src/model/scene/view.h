// SPDX-License-Identifier: Apache-2.0
// A capture: cameras, files and splits, in the capture frame .
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
  Camera camera;                     // capture frame; pixel centers at +0.5
  std::filesystem::path image_path;  // empty: a camera without a photograph
  std::filesystem::path mask_path;   // empty: the mask is the alpha of the image
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
  Vec3d up{0, 0, 1};                  // world axis that points up, capture frame
  std::vector<std::string> warnings;  // one sentence per assumption that the loader made
};

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
  virtual Image load(const View&) const = 0;  // RGBA, linear, straight alpha; alpha is the object mask
  virtual ImageDepth depth(const View&) const { return ImageDepth::bits8; }
};

}  // namespace cei3d
