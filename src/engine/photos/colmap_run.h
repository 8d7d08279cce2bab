// SPDX-License-Identifier: Apache-2.0
// Poses of bare photographs by the program COLMAP [Schoenberger and Frahm 2016], run as a process.
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/progress.h"

namespace cei3d {

struct PosingRequest {
  std::filesystem::path images;         // folder of the photographs, nothing else in it
  std::filesystem::path work;           // folder for the database and the log; kept to go on with
  std::filesystem::path sparse;         // folder to make: one model in each sub-folder
  std::filesystem::path feature_masks;  // NAME.jpg.png, black where no features are wanted; empty: everywhere
  bool one_camera = true;               // all photographs have the same intrinsics
  bool in_order = false;                // compare only neighbors
  // Neighbors are seen from similar directions, with few features. Tried also if it is not said, where else
  // many photographs have no pose.
  bool turntable = false;
  std::optional<double> focal;  // of the photographs in pixels; none: by their notes, else guessed
  int threads = 0;              // 0: all cores
};

// Error: COLMAP is not installed, with what to do.
void require_colmap();

// Whether find_poses() has nothing left to do.
bool poses_are_found(const PosingRequest&);

// Does what of it is not done yet. Reports the shares of progress between `first` and `last`. Errors: COLMAP
// fails, no model comes out, interrupted.
void find_poses(const PosingRequest&, double first, double last, Progress&);

// Gives the camera of a model that has one, of the kind SIMPLE_RADIAL, all of the lens that OPENCV's has: two
// focal lengths, k1, k2, p1, p2. It projects as before. False: several cameras, or others.
bool give_full_lens(const std::filesystem::path& model);

// Share of a COLMAP step that is done, by the end of what it printed; none where it does not say.
std::optional<double> colmap_progress(const std::string& log, size_t photos);

}  // namespace cei3d
