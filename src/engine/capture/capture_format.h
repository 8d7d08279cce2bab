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
  std::string layout;                                 // its files, for help and messages
  bool (*detect)(const std::filesystem::path& path);  // path: folder or file
  Capture (*load)(const std::filesystem::path& path);
};
const std::vector<CaptureFormat>& capture_formats();

// NeRF-synthetic and its kin: transforms_{train,val,test}.json or one transforms.json (all training views),
// OpenGL camera-to-world. A frame's own fl_x, fl_y, cx, cy, w, h win over the file's; mask_path is honored,
// and nerfstudio's lists train_filenames, val_filenames, test_filenames.
bool detect_nerf(const std::filesystem::path& path);
Capture load_nerf(const std::filesystem::path& path);

// PhySG: cam_dict_norm.json, image/, mask/, in the folder itself or in its train/ and test/. OpenCV
// world-to-camera, integer pixel centers.
bool detect_physg(const std::filesystem::path& path);
Capture load_physg(const std::filesystem::path& path);

// IDR, NeuS and their kin: cameras_sphere.npz or cameras.npz with world_mat_i = K [R | t], image/, mask/, all
// training views. OpenCV axes, integer pixel centers. The world of world_mat is the capture's frame;
// scale_mat_i (where their programs put the unit sphere) is not needed: our own normalization comes from the
// masks.
bool detect_idr(const std::filesystem::path& path);
Capture load_idr(const std::filesystem::path& path);

// JSON as it comes out of programs: NaN and Infinity are taken for null. Errors name the file.
Json read_json_file(const std::filesystem::path& path);
// A finite number or NaN (for null). Error: anything else. `where` is for the sentence.
double number_of(const Json& j, const std::string& where);
// 3 or 4 rows of a pose or camera matrix, nested ([[...], ...]) or flat ([...], 16 numbers). Row-major 3x4.
struct Matrix34 {
  double m[3][4];
};
Matrix34 matrix_of(const Json& j, const std::string& where);

// K [R | t] taken apart; up to a factor, so that also a negative one is understood. The picture size stays 0.
// Errors: not finite, not a projection. `where` is for the sentence.
Camera camera_from_projection(const Matrix34& p, const std::string& where);

// Files with a picture's suffix, sorted; none where there is no such folder.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);
// {0, 0} where there is no picture, or a broken one.
ImageSize size_of_picture(const std::filesystem::path& path);

}  // namespace cei3d
