// SPDX-License-Identifier: Apache-2.0
// `cei3d capture`: from bare photographs to a capture, with poses by COLMAP and masks of the object.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/progress.h"
#include "core/math/vec2.h"

namespace cei3d {

struct PhotosRequest {
  std::filesystem::path photos;  // folder of photographs, or a video
  std::filesystem::path out;  // folder of the capture: images/, masks/, sparse/; work/ is kept to go on with
  struct Click {
    std::string photo;  // name of a photograph, with or without suffix
    Vec2d pixel;
    bool object = true;
  };
  std::vector<Click> clicks;    // on the object, or beside it; empty: found by itself
  std::filesystem::path plate;  // photograph of the background without the object; empty: none
  bool turntable = false;       // the object turned before a camera that stood still; found out if not said
  bool masks = true;            // false: poses alone
  std::optional<double> focal;  // of the photographs, in pixels
  int frames = 100;             // that are taken of a video
  int threads = 0;              // 0: all cores
};

struct PhotosReport {
  std::filesystem::path out;
  size_t photos = 0, posed = 0;
  std::vector<std::string> without_pose, without_mask;  // names of photographs
  double seconds = 0;
  Json json() const;
};

// Goes on where an earlier call with the same folder stopped; other photographs in the folder are an error.
// Errors: COLMAP, the network or another program is not installed, with what to do; no poses; the object is
// not found. Interrupted Error: what is done is kept.
PhotosReport capture_photos(const PhotosRequest&, Progress&);

}  // namespace cei3d
