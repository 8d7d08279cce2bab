// SPDX-License-Identifier: Apache-2.0
// The table of capture formats, and what their loaders share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "engine/io/image_size.h"
#include "model/scene/view.h"

namespace cei3d {

struct CaptureFormat {
  std::string name;
  std::string programs;                               // programs and data sets that write this format
  std::string layout;                                 // its files, for help and messages
  std::optional<Vec3d> up;                            // none: the world frame is arbitrary
  bool (*detect)(const std::filesystem::path& path);  // path: folder or file
  Capture (*load)(const std::filesystem::path& path);
  // The axis that the files of this capture say points up; none, or null: they do not say so.
  std::optional<Vec3d> (*stated_up)(const std::filesystem::path& path) = nullptr;
};
const std::vector<CaptureFormat>& capture_formats();

// NeRF-synthetic, nerfstudio, instant-ngp: transforms_{train,val,test}.json or one transforms.json (all
// training views), OpenGL camera-to-world. A frame's own fl_x, fl_y, cx, cy, w, h and lens override the
// file's; mask_path and nerfstudio's lists train_filenames, val_filenames, test_filenames are read. Lenses:
// OPENCV and what it contains (k1, k2, k3, k4, p1, p2, or distortion_params) and OPENCV_FISHEYE. The capture
// frame is that of the file: applied_transform and applied_scale, which say how the frame was made from
// COLMAP's, change nothing. nerf_up(): z where orientation_override says that the frame is upright.
bool detect_nerf(const std::filesystem::path& path);
Capture load_nerf(const std::filesystem::path& path);
std::optional<Vec3d> nerf_up(const std::filesystem::path& path);

// PhySG: cam_dict_norm.json, image/, mask/, in the folder itself or in its train/ and test/. OpenCV
// world-to-camera, integer pixel centers.
bool detect_physg(const std::filesystem::path& path);
Capture load_physg(const std::filesystem::path& path);

// IDR, NeuS: cameras_sphere.npz or cameras.npz with world_mat_i = K [R | t], image/, mask/; all training
// views. OpenCV axes, integer pixel centers. The world of world_mat is the capture frame; scale_mat_i (the
// unit sphere of those programs) only bounds the object.
bool detect_idr(const std::filesystem::path& path);
Capture load_idr(const std::filesystem::path& path);

// COLMAP: cameras, images, points3D as .bin or .txt, in sparse/0, sparse, colmap/sparse/0, dense/sparse or
// the folder itself, of several models the one with most images; images in images/ or beside.
// World-to-camera, OpenCV axes.
bool detect_colmap(const std::filesystem::path& path);
Capture load_colmap(const std::filesystem::path& path);

// Metashape: an exported XML file of cameras. Camera-to-chunk, OpenCV axes; with several components in the
// frame of the chunk. Images are found by the labels of the cameras.
bool detect_metashape(const std::filesystem::path& path);
Capture load_metashape(const std::filesystem::path& path);

// RealityCapture, RealityScan: the CSV file of internal and external camera parameters, in any order of
// columns.
bool detect_realitycapture(const std::filesystem::path& path);
Capture load_realitycapture(const std::filesystem::path& path);

// LLFF: poses_bounds.npy and images/, joined by sorted order.
bool detect_llff(const std::filesystem::path& path);
Capture load_llff(const std::filesystem::path& path);

// Meshroom: cameras.sfm, sfm.json or another .sfm, of all versions that store rotations and centers of the
// poses.
bool detect_meshroom(const std::filesystem::path& path);
Capture load_meshroom(const std::filesystem::path& path);

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

// The path with slashes where programs on Windows write backslashes.
std::string with_slashes(std::string path);
// The name of a view whose image is file_path, relative to some folder: without suffix. View names become
// paths below an output folder and never lead out of it.
std::string view_name(const std::string& file_path, Split split);
// `file`, which a capture in the folder root names. Error: it lies neither in that folder nor in the one that
// holds it, so that opening a capture of somebody else reads no other files. Links are followed. where: for
// the error message.
std::filesystem::path own_file(const std::filesystem::path& root, const std::filesystem::path& file,
                               const std::string& where);
// The image, or in place of a HEIC file the JPEG beside it, which is made where there is none.
std::filesystem::path readable_image(const std::filesystem::path& image);
// Image files in a folder, sorted; none if the folder does not exist.
std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder);
// Size of an image file; {0, 0} if it is missing or broken.
ImageSize size_of_image(const std::filesystem::path& path);

}  // namespace cei3d
