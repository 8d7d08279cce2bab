// SPDX-License-Identifier: Apache-2.0
// True views as image files.
#pragma once

#include <filesystem>
#include <string>

#include "engine/synthetic/picture.h"

namespace cei3d {

// gt/depth: the value of a pixel is the depth times this.
inline constexpr double kDepthScale = 8192;

// sRGB, 8-bit RGBA, straight alpha.
void write_color(const std::filesystem::path& path, const Image& linear_rgba);
// Linear, with radiance above 1: FOLDER/image/STEM.exr and FOLDER/mask/STEM.png.
void write_radiance(const std::filesystem::path& folder, const std::string& stem, const Image& linear_rgba);
// gt/albedo, normal, depth, roughness, metalness and mask of a view, each as gt/<kind>/<stem>.png.
void write_truth(const std::filesystem::path& folder, const std::string& stem, const TrueView& view);
// Gaussian noise on the sRGB values, as a sensor's would be after development.
Image with_noise(Image linear_rgba, float deviation, uint64_t seed, uint64_t view);

}  // namespace cei3d
