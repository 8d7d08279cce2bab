// SPDX-License-Identifier: Apache-2.0
// Captures: posed photographs in known formats. Conventions of the input end here: afterwards axes are
// OpenCV's, pixel centers are at +0.5, and the frame is the capture's own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/view.h"

namespace cei3d {

struct CaptureOptions {
  std::string format;   // one of capture_format_names(); empty: detected from the files
  int test_every = 0;   // every Nth training view becomes a test view when the capture has none; 0: never
  int views = 0;        // number of training views to use, by keep_training_views(); 0: all
  bool strict = false;  // keep views whose images are missing; check() then reports them as errors
  // Instead of every Nth: this share of the training views, chosen at random by the seed; 0: none. Usage
  // error: the capture has a split of its own.
  double test_share = 0;
  uint64_t seed = 1;
};

// Loads cameras and file names, and of the images only sizes and masks (fit_to_photographs()). path: a
// folder, or its file of cameras. Views whose images are missing are left out, with a warning. Errors:
// unknown format, malformed cameras, no views.
Capture load_capture(const std::filesystem::path& path, const CaptureOptions& options = {});
// Whether the files of a known format are there, damaged or not: then load_capture() says what is wrong.
bool is_capture(const std::filesystem::path& path);

// "nerf-synthetic, physg, ...": the formats that load_capture() reads.
std::string capture_format_names();
// "NeRF-synthetic, nerfstudio, ...": the programs and data sets that they come from.
std::string capture_format_programs();
// One line per format: name, programs and files.
std::string capture_format_layouts(const std::string& separator);

const char* split_name(Split split);
std::optional<Split> split_from_name(const std::string& name);
std::vector<View> views_of(const Capture& capture, Split split);

// The view of a name: "train/r_055", "./train/r_055", either with an image suffix, or a bare "r_055" (that of
// the only split that has it, or else of train). Usage error if there is none; it lists similar names.
const View& find_view(const Capture& capture, const std::string& name);

struct CaptureSpec {
  std::filesystem::path path;
  std::optional<Split> split;
};
// Parses "DIR", "DIR:train", "DIR:val" or "DIR:test". Usage error: another word after the colon.
CaptureSpec parse_capture_spec(const std::string& spec);

}  // namespace cei3d
