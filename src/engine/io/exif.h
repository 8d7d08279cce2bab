// SPDX-License-Identifier: Apache-2.0
// What a camera wrote into a JPEG, by libexif.
#pragma once

#include <optional>
#include <string>

namespace cei3d {

struct ExifNotes {
  int orientation = 1;  // 1 to 8; 5 to 8 swap the sides
  // Relative light that reached the sensor, times its gain: time * ISO / f-number^2.
  std::optional<double> exposure;
  std::optional<double> focal_length;  // millimeters
  std::optional<bool> auto_white;      // whether the camera chose the white balance of this photograph itself
};

// bytes: the file, or a beginning of it that holds the notes. Whatever is missing or broken keeps its
// default.
ExifNotes read_exif(const std::string& bytes);

}  // namespace cei3d
