// SPDX-License-Identifier: Apache-2.0
// A frame for the screen, tile by tile.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/compute/device.h"
#include "engine/render/tiles.h"
#include "engine/session/look_requests.h"

namespace cei3d {

class Threads;

struct FrameTile {
  PixelBox box;
  std::vector<uint8_t> rgba;  // #pixels x 4, sRGB, straight alpha: as `render` stores it
};

class TiledFrame {
 public:
  // scene: under the light to show. camera: unit frame. The others must outlive this.
  TiledFrame(const Threads&, RenderCache&, Scene scene, const Camera& camera, int samples, Channel);

  std::optional<FrameTile> next();  // none: all are done
  size_t tiles_left() const { return boxes_.size() - done_; }

 private:
  const Threads& threads_;
  RenderCache& frames_;
  Scene scene_;
  Camera camera_;
  int samples_;
  Channel channel_;
  std::optional<SceneLight> light_;  // made with the first tile
  std::vector<PixelBox> boxes_;
  size_t done_ = 0;
};

}  // namespace cei3d
