// SPDX-License-Identifier: Apache-2.0
// Requests of somebody who looks at the object: frames, points under the pointer.
#pragma once

#include <string>
#include <vector>

#include "core/base/json.h"
#include "engine/session/requests.h"

namespace cei3d {

struct FrameRequest {
  Camera camera;  // capture frame
  Channel channel = Channel::rgb;
  int samples = 1;               // per pixel and axis
  LightChoice light;             // to look under another light, which is no edit
  bool as_photographed = false;  // under the light that a photograph by this camera was taken in
};
// Surface seen at a pixel; positions in the capture frame.
struct PickedPoint {
  Vec3d position, normal;
  double depth = 0;    // along the camera's axis
  std::string albedo;  // "#RRGGBB", sRGB
  double roughness = 0, specular = 0, metalness = 0;
  std::vector<std::string> parts;  // that it belongs to
  Json json() const;
};
struct NamedCamera {
  std::string name;  // "test/r_000"
  std::string file;  // "r_000", or the whole name where two views share the last part
  Camera camera;
};

}  // namespace cei3d
