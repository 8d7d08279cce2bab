// SPDX-License-Identifier: Apache-2.0
// A whole joint descent, and the judgment whether it was worth it.
#pragma once

#include "core/base/clock.h"
#include "engine/reconstruct/joint/joint_descent.h"
#include "model/scene/scene.h"

namespace cei3d {

struct JointStageOptions {
  JointOptions descent;
  int steps = 400;
  double seconds = 0;  // > 0: time limit
  Clock clock = steady_seconds;
  ShowAppearance show{};  // may be empty
  double spent = 0;       // s of `seconds` that earlier parts of the descent took
  DescentStore store{};
};

// Error: interrupted.
JointObject descend_jointly(const Device&, const AppearanceInput&, const PixelStore&, JointObject start,
                            const JointStageOptions&, Progress&);

// PSNR (dB, display-encoded) by light and material on the samples that a joint descent leaves out, whose rays
// are traced again on the scene's surface. Where they miss it, the pixel is black. Error: interrupted.
double held_out_psnr(const Device&, const Scene&, const SurfaceSamples&, const Progress&);

}  // namespace cei3d
