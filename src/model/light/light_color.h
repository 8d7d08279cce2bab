// SPDX-License-Identifier: Apache-2.0
// The color of a light as it is believed before the photographs are looked at, and weighed against what they
// say. (docs/method.md#the-color-of-the-light)
#pragma once

#include <optional>
#include <string>

#include "core/math/vec.h"

namespace cei3d {

struct LightColorPrior {
  enum class Kind {
    free,        // what the photographs say
    near_white,  // lamps and skies are nearly white, and photographs balanced for them
    known        // `color`
  };
  Kind kind = Kind::near_white;
  Vec3f color{1, 1, 1};  // of a known light: its mean radiance, up to a factor
};
std::string light_color_text(const LightColorPrior&);                 // "free", "near-white" or "R,G,B"
std::optional<LightColorPrior> light_color_from(const std::string&);  // nothing: none of these

// How well the strength of a light is known: the covariance of the logarithms of its three channels.
using LightCovariance = Mat3d;

// A factor on the light, per channel, and how well it is known.
struct LightScale {
  Vec3f factor{1, 1, 1};
  LightCovariance covariance;
  Vec3d reflected{0, 0, 0};  // mean square of what reflections vary in the photographs, display units
};

// The error of each channel, as a share of it; nothing where the covariance is zero.
std::optional<Vec3f> relative_error(const LightCovariance&);

struct LightBelief {
  Vec3f factor{1, 1, 1};       // on the light, per channel
  LightCovariance covariance;  // of the light with that factor
};
// evidence: what the photographs say of the light. mean: its radiance.
LightBelief weigh_light_color(const LightScale& evidence, Vec3f mean, const LightColorPrior&);

}  // namespace cei3d
