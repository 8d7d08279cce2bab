// SPDX-License-Identifier: Apache-2.0
// Cameras around the unit sphere, and their files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/math/camera.h"

namespace cei3d {

struct Lens {
  int width = 0, height = 0;  // pixels
  double focal = 0;           // pixels
};
// The shorter side covers 0.6 radians: the unit sphere seen from a distance of 3.5.
Lens lens_of_size(int width, int height);

// Upright, looking from `eye` at `target`; the principal point is the middle of the image.
Camera look_at(Vec3d eye, Vec3d target, const Lens&, Vec3d up = {0, 0, 1});

// n cameras at a distance of 3.5 that look at the origin, spread evenly over the sphere above z = -0.5.
std::vector<Camera> spread_cameras(int n, const Lens&);
// Test cameras, a little nearer, on a spiral of five turns over the same part of the sphere.
std::vector<Camera> spiral_cameras(int n, const Lens&);

std::string view_stem(size_t index);  // "r_007"

// One entry of "frames" in a NeRF-synthetic file. [camera to world, OpenGL axes: y up, z backwards]
Json nerf_frame(const std::string& file_path, const Camera&);
// transforms_<split>.json for images <split>/r_000.png ... cameras: of one size and focal length.
void write_nerf_cameras(const std::filesystem::path& folder, const std::string& split,
                        std::span<const Camera> cameras);

// <split>/cam_dict_norm.json in PhySG's layout, for images <split>/image/r_000.exr and so on; its pixel
// centers are at whole numbers.
void write_physg_cameras(const std::filesystem::path& folder, const std::string& split,
                         std::span<const Camera> cameras);

}  // namespace cei3d
