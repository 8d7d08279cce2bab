// SPDX-License-Identifier: Apache-2.0
// Bare photographs: a folder of them, or a video.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"

namespace cei3d {

struct PhotoFiles {
  std::vector<std::string> names;  // in the folder that they were copied to, sorted
  bool in_order = false;           // neighbors show nearly the same: frames of a video
  bool one_camera = true;          // all have one size and one focal length, as far as their notes say
};

// Copies photographs into the folder `to`, as they are; those that are there already stay. HEIC files become
// JPEG by heif-convert, and of a video `frames` images are taken by ffmpeg. from: a folder of photographs, or
// a video file. Errors: fewer than kMinPhotos, two photographs of the same name, no such programs.
PhotoFiles copy_photos(const std::filesystem::path& from, const std::filesystem::path& to, int frames,
                       const Progress&);
inline constexpr size_t kMinPhotos = 8;

}  // namespace cei3d
