// SPDX-License-Identifier: Apache-2.0
// Check of a capture: what the loader understood, and every problem with its fix.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/image/area.h"
#include "core/image/image.h"
#include "engine/io/image_size.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

enum class Severity { note, warning, error };  // error: reconstruct refuses the capture

struct Finding {
  Severity severity = Severity::error;
  std::string what, fix;  // sentences
  // Names of the views that it is about; empty: it is about the capture as a whole. The sentence names the
  // first few.
  std::vector<std::string> views = {};
  // A safe change of the capture that removes the cause; empty: there is none.
  std::function<void(Capture&)> repair = {};
  bool marked = true;  // whether its views have a red frame; false: the pictures themselves show it
};

struct SplitReport {
  Split split = Split::train;
  int views = 0;
  ImageSize size;  // of the first image
  bool sizes_vary = false;
  // Object pixels / all pixels: mean, minimum, maximum
  double coverage = 0, coverage_min = 0, coverage_max = 0;
};

struct CaptureReport {
  std::string format;
  Vec3d up{0, 0, 1};                           // capture frame
  std::vector<SplitReport> splits;             // splits with views
  std::optional<Normalization> normalization;  // none: it could not be determined
  // Training cameras to the object's center, input units.
  double distance_min = 0, distance = 0, distance_max = 0;
  // Where the mask of a view contradicts the other views so much that it is overruled.
  struct Doubt {
    std::string view;
    Area area;  // [camera.height][camera.width]
  };
  std::vector<Doubt> doubts;
  std::vector<Finding> findings;  // errors first

  bool usable() const;
};

// Reads every image of the split (default: all splits) on all threads; takes seconds.
CaptureReport check(const Capture& capture, std::optional<Split> only = std::nullopt);

// Throws one Error with all fatal findings, the first few in full.
void require_usable(const CaptureReport& report);
void require_usable(const Capture& capture);  // checks the training views first

// Draws cameras and the object's bounding sphere, from above (left, up axis towards the viewer) and from the
// side (right, up axis up). RGB, sRGB. Training cameras blue, validation green, test orange, with viewing
// directions. size: pixels per panel.
Image draw_cameras(const Capture& capture, const Normalization& normalization, int size = 480);

}  // namespace cei3d
