// SPDX-License-Identifier: Apache-2.0
// From photographs to an editable object. The stages are in engine/reconstruct/stages.h.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/base/json.h"
#include "core/base/progress.h"
#include "model/light/light_color.h"
#include "model/scene/scene.h"

namespace cei3d {

struct Image;

// Gets what the object looks like while it is being made: display-encoded RGB over white, a side of at most
// 160 pixels. Called by the run, which takes about a fortieth of its time to draw.
using ShowPicture = std::function<void(const Image&)>;

struct ReconstructOptions {
  std::string preset = "fast";  // "fast", "balanced" or "paper" (engine/reconstruct/presets.h)
  double seconds = 0;           // time of the whole run; 0: no limit, the steps of the preset decide
  // Steps of the geometry stage, instead of seconds; the result is then a function of the seed.
  int iterations = 0;
  int joint_steps = -1;  // of the joint descent, at most; 0: none; -1: the preset's
  uint64_t seed = 1;
  // Use images at 1/N of their size; 0: as engine/session/photograph_size.h has it.
  int downscale = 0;
  int test_every = 8;     // hold out every Nth view when the capture has no split; 0: none
  double test_share = 0;  // instead: hold out this share of the views, chosen at random by the seed
  std::optional<LightMotion> light;  // how the light moves against the object; none: to be found
  LightColorPrior light_color;
  // Whether poses (and with them the focal length) and exposures of the training views are refined, where
  // start shapes are compared and it pays.
  bool refine_poses = true, fit_exposures = true;
  int views = 0;  // number of training views, by keep_training_views(); 0: all
  // Values of the preset that differ from it, by key (engine/reconstruct/preset_settings.h).
  Json set = Json::object();
};

// Storage of training states. Head and tensors of a checkpoint are stored together or not at all.
class Checkpoints {
 public:
  struct State {
    Json head;
    Tensors tensors;
  };
  virtual ~Checkpoints() = default;
  virtual void save(const State&) = 0;
  virtual std::optional<State> latest() = 0;  // the state to resume from; none: start anew
};

// show: empty: no observer; a run by steps makes the same object either way. Error: interrupted, after saving
// a checkpoint, when progress.cancelled().
Scene reconstruct(const Device&, const Capture&, const ImageSource&, const Normalization&,
                  const ReconstructOptions&, Checkpoints&, Progress&, ShowPicture show = {});

}  // namespace cei3d
