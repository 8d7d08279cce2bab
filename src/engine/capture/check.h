// SPDX-License-Identifier: Apache-2.0
// What was understood of a capture, and everything that is wrong with it, with the fix.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "engine/io/image_size.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

enum class Severity { note, warning, error };  // error: reconstruct would refuse

struct Finding {
  Severity severity = Severity::error;
  std::string what, fix;  // sentences
};

struct SplitReport {
  Split split = Split::train;
  int views = 0;
  ImageSize size;
  double coverage = 0, coverage_min = 0, coverage_max = 0;  // object pixels / all pixels: mean, least, most
};

struct CaptureReport {
  std::string format;
  Vec3d up{0, 0, 1};                           // input frame
  std::vector<SplitReport> splits;             // those that have views
  std::optional<Normalization> normalization;  // nothing when it could not be found
  double distance_min = 0, distance = 0,
         distance_max = 0;        // training cameras to the object's center, input units
  std::vector<Finding> findings;  // errors first

  bool usable() const;
};

// Reads every picture of the split (all splits by default) on all threads: seconds.
CaptureReport check(const Capture& capture, std::optional<Split> only = std::nullopt);

// Throws one Error that says all fatal findings (the first few in full).
void require_usable(const CaptureReport& report);
void require_usable(const Capture& capture);  // checks the training views first

// Cameras and the object's bounding sphere from above (left; up axis to the viewer) and from the side (right;
// up axis up). RGB, sRGB. Training cameras blue, validation green, test orange, with their viewing
// directions. size: pixels a panel.
Image draw_cameras(const Capture& capture, const Normalization& normalization, int size = 480);

}  // namespace cei3d
