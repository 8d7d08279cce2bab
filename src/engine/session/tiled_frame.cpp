// SPDX-License-Identifier: Apache-2.0
#include "engine/session/tiled_frame.h"

#include <cmath>

#include "core/base/parallel.h"
#include "engine/session/frame_files.h"

namespace cei3d {
namespace {

// A tile takes some hundredths of a second: the time after which a newer request is heard.
constexpr int kSide[] = {0, 128, 64};  // pixels, by samples

int side_of(int samples) { return kSide[samples < 2 ? 1 : 2]; }

uint8_t byte_of(float v) { return uint8_t(std::lround(clamp(v, 0.0f, 1.0f) * 255)); }

// The far end of the depths is the camera's distance plus the object's radius.
double depth_scale(const Camera& camera, const Normalization& n) {
  return 65535 * n.scale / (length(camera.center) + 1);
}

std::vector<uint8_t> rgba_of(const Frame& frame, Channel channel, double depth) {
  const Image picture = channel_image(frame, channel, depth);
  std::vector<uint8_t> out(4 * frame.mask.data.size());
  for (size_t p = 0; p < frame.mask.data.size(); ++p) {
    const float* v = &picture.data[p * size_t(picture.channels)];
    for (size_t c = 0; c < 3; ++c) out[4 * p + c] = byte_of(v[picture.channels == 1 ? 0 : c]);
    out[4 * p + 3] = byte_of(frame.mask.data[p]);
  }
  return out;
}

}  // namespace

TiledFrame::TiledFrame(const Threads& threads, RenderCache& frames, Scene scene, const Camera& camera,
                       int samples, Channel channel)
    : threads_(threads),
      frames_(frames),
      scene_(std::move(scene)),
      camera_(camera),
      samples_(samples),
      channel_(channel),
      boxes_(tiles_of(camera.width, camera.height, side_of(samples))) {}

std::optional<FrameTile> TiledFrame::next() {
  if (done_ == boxes_.size()) return std::nullopt;
  return threads_.run([&]() -> std::optional<FrameTile> {
    if (!light_) light_.emplace(frames_.light(scene_));
    const PixelBox box = boxes_[done_++];
    const Frame tile = render_tile(frames_, scene_, *light_, camera_, samples_, box);
    return FrameTile{box, rgba_of(tile, channel_, depth_scale(camera_, scene_.normalization))};
  });
}

}  // namespace cei3d
