// SPDX-License-Identifier: Apache-2.0
// Captures: posed photographs in the formats that people have. All conventions end here: OpenCV axes, pixel
// centers at +0.5, the capture's own world frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/view.h"

namespace cei3d {

struct CaptureOptions {
  std::string format;  // one of capture_format_names(); empty: detected from the files
  int test_every = 0;  // every Nth training view becomes a test view when the capture has none; 0: never
  int views = 0;       // train on so many only, those of keep_training_views(); 0: on all
};

// Cameras and file names; pictures are not read (but for the size of one a split). path: a folder, or its
// .json or .npz. Missing pictures are no error here: check() lists them all. Errors: nothing recognized,
// malformed cameras, no views.
Capture load_capture(const std::filesystem::path& path, const CaptureOptions& options = {});

// "nerf-synthetic, physg, ...": the formats that load_capture() reads.
std::string capture_format_names();
// The programs and the files of each format.
std::string capture_format_layouts(const std::string& separator);

const char* split_name(Split split);
std::optional<Split> split_from_name(const std::string& name);
std::vector<View> views_of(const Capture& capture, Split split);

// "train/r_055", "./train/r_055", with a picture's suffix, or a bare "r_055" when only one split has it (else
// the training view). Error (usage) with near names when there is none.
const View& find_view(const Capture& capture, const std::string& name);

struct CaptureSpec {
  std::filesystem::path path;
  std::optional<Split> split;
};
// "DIR", "DIR:train", "DIR:val", "DIR:test". Error (usage): another word after the colon.
CaptureSpec parse_capture_spec(const std::string& spec);

}  // namespace cei3d
