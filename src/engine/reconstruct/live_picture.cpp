// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/live_picture.h"

#include <algorithm>

#include "core/math/color.h"
#include "engine/render/render.h"

namespace cei3d {
namespace {

// Between pictures: at least 3 s, and 100 times as long as the last one took.
constexpr double kSeconds = 3, kShare = 100;
constexpr int kSide = 160;  // pixels, at most

Camera of_picture_size(const Camera& c) {
  return scaled(c, (std::max(c.width, c.height) + kSide - 1) / kSide);
}

Image displayed_over_white(const Image& rgba) {
  Image out(rgba.width, rgba.height, 3);
  for (int y = 0; y < rgba.height; ++y)
    for (int x = 0; x < rgba.width; ++x) {
      const float* p = rgba.at(x, y);
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = srgb_from_linear(p[c]) * p[3] + 1 - p[3];
    }
  return out;
}

}  // namespace

LivePicture::LivePicture(const Camera& unit_camera, ShowPicture show, Clock clock)
    : camera_(of_picture_size(unit_camera)), show_(std::move(show)), clock_(std::move(clock)) {}

void LivePicture::offer(const std::function<Image(const Camera&)>& draw) {
  if (!show_) return;
  const double begin = clock_();
  if (begin < next_) return;
  show_(draw(camera_));
  const double end = clock_();
  next_ = end + std::max(kSeconds, kShare * (end - begin));
}

Image lit_picture(const Device& device, const LitSurface& now, const Camera& unit_camera) {
  Scene shape;
  shape.sdf = std::shared_ptr<const Field>(&now.sdf, [](const Field*) {});
  shape.surface = now.surface;
  const GBuffer seen = trace_view(device, shape, unit_camera, 2);
  const std::vector<Vec3f> positions = positions_of(seen.hits);
  const std::vector<Material> materials = now.material.at(device, positions);
  const std::vector<uint16_t> first_view(seen.hits.size(), 0);
  const std::vector<ShadingTerms<float>> terms =
      now.lighting.terms({seen.hits, materials, {now.turns, first_view}});
  std::vector<Vec3f> radiance = now.albedo.eval3(device, positions);
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = terms[i].radiance(radiance[i]);
  return displayed_over_white(filtered_albedo(seen, radiance));
}

}  // namespace cei3d
