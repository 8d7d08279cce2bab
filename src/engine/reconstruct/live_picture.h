// SPDX-License-Identifier: Apache-2.0
// Small pictures of the object from one camera, shown now and then while it is made. They do not change the
// object, but a run with a time limit has less time for it.
#pragma once

#include <functional>
#include <utility>

#include "core/base/clock.h"
#include "core/compute/device.h"
#include "core/image/image.h"
#include "core/math/camera.h"
#include "engine/reconstruct/reconstruct.h"
#include "engine/render/lighting.h"
#include "model/scene/scene.h"

namespace cei3d {

class LivePicture {
 public:
  // show: may be empty, then no picture is made. unit_camera: of the first training view.
  LivePicture(const Camera& unit_camera, ShowPicture show, Clock clock);

  // To be called between steps. If a picture is due, shows the one that draw() makes: over white,
  // display-encoded.
  void offer(const std::function<Image(const Camera&)>& draw);

 private:
  Camera camera_;
  ShowPicture show_;
  Clock clock_;
  double next_ = 0;  // by the clock
};

// Light and appearance of a surface as far as they are known. turns: of the training views; null: the light
// stands still.
struct LitSurface {
  const Field& sdf;
  const std::shared_ptr<const Surface>& surface;
  const Lighting& lighting;
  const Field& albedo;
  const MaterialField& material;
  const LightTurns* turns;
};

// The picture of the camera, which is that of the first training view: over white, display-encoded.
Image lit_picture(const Device&, const LitSurface&, const Camera& unit_camera);

}  // namespace cei3d
