// SPDX-License-Identifier: Apache-2.0
// The object while it is made, for whoever looks: now and then a small picture from one camera. Whether
// somebody looks changes nothing of the object but what a run by time can do in the time.
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
  // show: empty: nobody looks. unit_camera: of the first training view.
  LivePicture(const Camera& unit_camera, ShowPicture show, Clock clock);

  // Between steps. Where a picture is due, draw() makes it: over white, display-encoded.
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

// As the first training view shows it.
Image lit_picture(const Device&, const LitSurface&, const Camera& unit_camera);

}  // namespace cei3d
