// SPDX-License-Identifier: Apache-2.0
// What the capture formats share, and their list. A format is a pair detect, load.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "engine/io/image_size.h"
#include "model/scene/view.h"

namespace cei3d {

struct CaptureFormat {
  std::string name;
  bool (*detect)(const std::filesystem::path& path);  // path: folder or file
  Capture (*load)(const std::filesystem::path& path);
};
const std::vector<CaptureFormat>& capture_formats();

// NeRF-synthetic and its kin: transforms_{train,val,test}.json or one transforms.json (all training views),
// OpenGL camera-to-world. A frame's own fl_x, fl_y, cx, cy, w, h win over the file's; mask_path is honoured.
// [reference-facts 1.5]
bool detect_nerf(const std::filesystem::path& path);
Capture load_nerf(const std::filesystem::path& path);

// PhySG: cam_dict_norm.json, image/, mask/, in the folder itself or in its train/ and test/. OpenCV
// world-to-camera, integer pixel centres. [reference-facts 1.1]
bool detect_physg(const std::filesystem::path& path);
Capture load_physg(const std::filesystem::path& path);

// JSON as it comes out of programs: NaN and Infinity are taken for null. Errors name the file.
Json read_json_file(const std::filesystem::path& path);
// A finite number or NaN (for null). Error: anything else. `where` is for the sentence.
double number_of(const Json& j, const std::string& where);
// 3 or 4 rows of a pose or camera matrix, nested ([[...], ...]) or flat ([...], 16 numbers). Row-major 3x4.
struct Matrix34 {
  double m[3][4];
};
Matrix34 matrix_of(const Json& j, const std::string& where);

// {0, 0} where there is no picture, or a broken one.
ImageSize size_of_picture(const std::filesystem::path& path);

}  // namespace cei3d
