// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/truth_files.h"

#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

// (n + 1) / 2; 0 where there is no normal.
Image encoded_normals(Image normals) {
  for (size_t i = 0; i < normals.data.size(); i += 3) {
    float* n = &normals.data[i];
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
    for (int c = 0; c < 3; ++c) n[c] = 0.5f * (n[c] + 1);
  }
  return normals;
}

Image encoded_depth(Image depth) {
  for (float& v : depth.data) v *= float(kDepthScale / 65535);
  return depth;
}

Image gray_with_alpha(const Image& gray, const Image& rgba) {
  Image out = rgba;
  for (size_t i = 0; i < gray.data.size(); ++i)
    for (size_t c = 0; c < 3; ++c) out.data[4 * i + c] = gray.data[i];
  return out;
}

Image alpha_of(const Image& rgba) {
  Image out(rgba.width, rgba.height, 1);
  for (size_t i = 0; i < out.data.size(); ++i) out.data[i] = rgba.data[4 * i + 3];
  return out;
}

}  // namespace

void write_color(const std::filesystem::path& path, const Image& linear_rgba) {
  write_png(path, srgb_from_linear(linear_rgba));
}

void write_radiance(const std::filesystem::path& folder, const std::string& stem, const Image& linear_rgba) {
  write_exr(folder / "image" / (stem + ".exr"), linear_rgba);
  write_png(folder / "mask" / (stem + ".png"), alpha_of(linear_rgba));
}

void write_truth(const std::filesystem::path& folder, const std::string& stem, const TrueView& view) {
  const auto file = [&](const char* kind) { return folder / "gt" / kind / (stem + ".png"); };
  write_color(file("albedo"), view.albedo);
  write_png(file("normal"), encoded_normals(view.normal), 16);
  write_png(file("depth"), encoded_depth(view.depth), 16);
  write_png(file("roughness"), gray_with_alpha(view.roughness, view.color));
  write_png(file("metalness"), gray_with_alpha(view.metalness, view.color));
  write_png(file("mask"), alpha_of(view.color));
}

Image with_noise(Image image, float deviation, uint64_t seed, uint64_t view) {
  if (deviation <= 0) return image;
  for (size_t i = 0; i < image.data.size(); i += 4) {
    if (image.data[i + 3] <= 0) continue;
    Rng rng(seed, view, i);
    for (size_t c = 0; c < 3; ++c)
      image.data[i + c] =
          linear_from_srgb(max(srgb_from_linear(image.data[i + c]) + deviation * rng.normal(), 0.0f));
  }
  return image;
}

}  // namespace cei3d
