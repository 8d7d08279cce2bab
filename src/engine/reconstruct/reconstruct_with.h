// SPDX-License-Identifier: Apache-2.0
// reconstruct() with preset, clock and rates as arguments, for tests.
#pragma once

#include <optional>

#include "engine/reconstruct/plan.h"

namespace cei3d {

struct ReconstructInputs {
  const Device& device;
  const Capture& capture;
  const ImageSource& images;
  const Normalization& normalization;
  ReconstructOptions options;  // its preset's name is not read
  Preset preset;
  Clock clock = steady_seconds;
  std::optional<Rates> rates{};  // of this machine; none: measured, if the run is timed
  ShowPicture show{};            // empty: no observer
};

Scene reconstruct(const ReconstructInputs&, Checkpoints&, Progress&);

}  // namespace cei3d
