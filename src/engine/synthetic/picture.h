// SPDX-License-Identifier: Apache-2.0
// A view of a synthetic scene, with the truth of every pixel.
#pragma once

#include <functional>

#include "core/image/image.h"
#include "engine/synthetic/path_tracer.h"

namespace cei3d {

struct TrueView {
  Image color;   // RGBA, linear radiance, straight alpha: the share of the pixel that is covered
  Image albedo;  // RGBA, linear
  Image normal;  // 3 channels, unit; zero where there is nothing
  Image depth;   // 1 channel, along the camera's axis; zero where there is nothing
  Image roughness, metalness;  // 1 channel
};

struct Sampling {
  int samples = 32;  // per pixel; powers of two are stratified best
  uint64_t seed = 1;
  uint64_t view = 0;  // views of different numbers have independent noise
};

// The same bits for any number of threads.
TrueView draw(const SyntheticScene&, const Camera&, const Sampling&);

// One ray through the center of every pixel, without light: RGBA, linear. color_at: of a point on the
// surface.
Image draw_unlit(const Body&, const Camera&, const std::function<Vec3f(Vec3f)>& color_at);

}  // namespace cei3d
