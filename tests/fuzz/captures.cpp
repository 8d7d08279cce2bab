// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: files of cameras of every format, beside two images. The first byte of the input chooses
// the file, the rest is its content. What can be loaded is checked. Anything but a report or an Error is a
// finding.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/capture.h"
#include "engine/capture/check.h"
#include "engine/io/png_file.h"

namespace {
namespace fs = std::filesystem;

struct Target {
  const char* format;
  const char* file;
};
// The first byte of every stored input counts these: new ones stand at the end.
constexpr Target kTargets[] = {
    {"nerf-synthetic", "transforms.json"},
    {"physg", "cam_dict_norm.json"},
    {"idr", "cameras.npz"},
    {"colmap", "cameras.txt"},
    {"colmap", "images.txt"},
    {"colmap", "points3D.txt"},
    {"colmap", "cameras.bin"},
    {"colmap", "images.bin"},
    {"metashape", "cameras.xml"},
    {"realitycapture", "cameras.csv"},
    {"llff", "poses_bounds.npy"},
    {"meshroom", "cameras.sfm"},
    {"colmap", "points3D.bin"},
};

void write_plainly(const fs::path& path, const std::string& bytes) {
  if (FILE* file = std::fopen(path.c_str(), "wb")) {
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 1) return 0;
  const Target& target = kTargets[data[0] % std::size(kTargets)];
  const fs::path folder = fs::temp_directory_path() / ("cei3d_fuzz_" + std::to_string(::getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  if (target.format == std::string("colmap")) {  // is read when it has cameras and images
    write_plainly(folder / "cameras.txt", "1 PINHOLE 8 8 9 9 4 4\n");
    write_plainly(folder / "images.txt", "1 1 0 0 0 0 0 0 1 a.png\n1 2 1\n");
  }
  write_plainly(folder / target.file, {reinterpret_cast<const char*>(data) + 1, size - 1});
  static const std::string image = [] {
    cei3d::Image rgba(8, 8, 4, 0.0f);
    for (int y = 2; y < 6; ++y) std::fill_n(rgba.at(3, y), 12, 1.0f);
    return cei3d::encode_png(rgba, 8);
  }();
  for (const char* place : {"images", "image"}) fs::create_directories(folder / place);
  for (const char* name : {"a.png", "image/a.png", "images/a.png", "images/b.png"})
    write_plainly(folder / name, image);
  try {
    cei3d::check(cei3d::load_capture(folder, {target.format}));
  } catch (const cei3d::Error&) {
  }
  fs::remove_all(folder);
  return 0;
}
