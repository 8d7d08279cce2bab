// SPDX-License-Identifier: Apache-2.0
// The table of capture formats, and what their loaders share.
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

// NeRF-synthetic, nerfstudio, instant-ngp: transforms_{train,val,test}.json or one transforms.json (all
// training views), OpenGL camera-to-world. A frame's own fl_x, fl_y, cx, cy, w, h override the file's;
// mask_path and nerfstudio's lists train_filenames, val_filenames, test_filenames are read.
bool detect_nerf(const std::filesystem::path& path);
Capture load_nerf(const std::filesystem::path& path);

// PhySG: cam_dict_norm.json, image/, mask/, in the folder itself or in its train/ and test/. OpenCV
// world-to-camera, integer pixel centers.
bool detect_physg(const std::filesystem::path& path);
Capture load_physg(const std::filesystem::path& path);

// IDR, NeuS: cameras_sphere.npz or cameras.npz with world_mat_i = K [R | t], image/, mask/; all training
// views. OpenCV axes, integer pixel centers. The world of world_mat is the capture frame; scale_mat_i (the
// unit sphere of those programs) only bounds the object.
bool detect_idr(const std::filesystem::path& path);
Capture load_idr(const std::filesystem::path& path);

// Reads JSON; NaN and Infinity, which Python writes, become null. Errors name the file.
Json read_json_file(const std::filesystem::path& path);
// A finite number, or NaN for null. Error: anything else. where: for the error message.
double number_of(const Json& j, const std::string& where);
// Reads 3 or 4 rows of a pose or camera matrix, nested ([[...], ...]) or flat ([...], 16 numbers). Row-major
// 3x4.
struct Matrix34 {
  double m[3][4];
};
Matrix34 matrix_of(const Json& j, const std::string& where);

// Decomposes K [R | t], which may be scaled by any factor, also a negative one. The image size stays 0.
// Errors: not finite, not a projection. where: for the error message.
Camera camera_from_projection(const Matrix34& p, const std::string& where);

// Image files in a folder, sorted; none if the folder does not exist.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);
// Size of an image file; {0, 0} if it is missing or broken.
ImageSize size_of_image(const std::filesystem::path& path);

}  // namespace cei3d
