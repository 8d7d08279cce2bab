// SPDX-License-Identifier: Apache-2.0
// A prior of the color of a light, and its combination with the estimate from the photographs.
// (docs/method.md#the-color-of-the-light)
#pragma once

#include <optional>
#include <string>

#include "core/math/vec.h"

namespace cei3d {

struct LightColorPrior {
  enum class Kind {
    free,        // no prior: the estimate from the photographs alone
    near_white,  // lamps and skies are nearly white, and photographs are white-balanced
    known        // `color`
  };
  Kind kind = Kind::near_white;
  Vec3f color{1, 1, 1};  // of a known light: its mean radiance, up to a factor
};
std::string light_color_text(const LightColorPrior&);                 // "free", "near-white" or "R,G,B"
std::optional<LightColorPrior> light_color_from(const std::string&);  // none: not one of these

// How well the strength of a light is known: the covariance of the logarithms of its three channels.
using LightCovariance = Mat3d;

// Estimate of a factor on the light, per channel.
struct LightScale {
  Vec3f factor{1, 1, 1};
  LightCovariance covariance;
  // Mean square, within vertices, of the variation that reflections explain; display units.
  Vec3d reflected{0, 0, 0};
};

// Standard error of each channel, relative; none where the covariance is zero.
std::optional<Vec3f> relative_error(const LightCovariance&);

struct LightBelief {
  Vec3f factor{1, 1, 1};       // on the light, per channel
  LightCovariance covariance;  // of the light with that factor
};
// Combines the estimate with the prior. evidence: estimate from the photographs. mean: mean radiance of the
// light, linear.
LightBelief weigh_light_color(const LightScale& evidence, Vec3f mean, const LightColorPrior&);

}  // namespace cei3d
