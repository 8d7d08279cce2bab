// SPDX-License-Identifier: Apache-2.0
// Photographs to an editable object. The stages are in engine/reconstruct/stages.h.
#pragma once

#include <optional>
#include <string>

#include "core/base/progress.h"
#include "model/light/light_color.h"
#include "model/scene/scene.h"

namespace cei3d {

struct ReconstructOptions {
  std::string preset = "fast";  // "fast", "balanced" or "paper" (engine/reconstruct/presets.h)
  double seconds = 0;           // for the whole run; 0: as long as the preset's steps take
  int iterations = 0;  // of the geometry stage, instead of seconds: makes a run a function of the seed alone
  uint64_t seed = 1;
  int downscale = 1;                 // use images at 1/N of their size
  int test_every = 8;                // hold out every Nth view when the capture has no split; 0: none
  std::optional<LightMotion> light;  // how it moves against the object; nothing: to be found
  LightColorPrior light_color;
  int views = 0;  // train on so many, spread evenly (engine/capture/spread.h); 0: on all
};

// Where the trainer puts its state. Both files of a checkpoint appear or neither.
class Checkpoints {
 public:
  struct State {
    Json head;
    Tensors tensors;
  };
  virtual ~Checkpoints() = default;
  virtual void save(const State&) = 0;
  virtual std::optional<State> latest() = 0;  // what to resume from; nothing: start anew
};

// Error: interrupted, after saving a checkpoint, when progress.cancelled().
Scene reconstruct(const Device&, const Capture&, const ImageSource&, const Normalization&,
                  const ReconstructOptions&, Checkpoints&, Progress&);

}  // namespace cei3d
