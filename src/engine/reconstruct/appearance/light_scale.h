// SPDX-License-Identifier: Apache-2.0
// The strength of a light from the reflections of dielectrics, by generalized least squares.
// (docs/method.md#the-color-of-the-light)
#pragma once

#include <algorithm>
#include <vector>

#include "core/math/vec.h"
#include "model/light/light_color.h"

namespace cei3d {

// A sample of a dielectric vertex. Per channel color = D * diffuse + t * reflected, with the diffuse radiance
// D of the vertex and the factor t on the light.
struct ReflectionSample {
  Vec3f weight;  // SplitRow::weight
  Vec3f diffuse, reflected, color;
};

// Noise of the samples. Besides errors of each channel, the diffuse term varies as a whole, in the color of
// the surface: pixels that show a neighbor, other exposures, a lamp that moved. Variation in that color must
// not count as reflection.
struct SampleNoise {
  double color = 1;    // variance of a channel, display units
  double diffuse = 0;  // variance of the strength of the diffuse light, relative
};

// Least-squares D >= 0 of a vertex for t = 1.
Vec3f diffuse_of(const std::vector<ReflectionSample>& of_vertex);

// Accumulates the noise estimate over vertices.
class NoiseSums {
 public:
  void add(const std::vector<ReflectionSample>& of_vertex);
  SampleNoise noise() const;
  // Mean square of the variation of the reflections within vertices, per channel, display units.
  Vec3d reflected() const { return reflected_ / double(std::max<size_t>(samples_, 1)); }

 private:
  Vec3d reflected_{0, 0, 0};
  double along_ = 0, across_ = 0, diffuse_ = 0;  // squared errors along D and across it, squares of D
  size_t samples_ = 0;
};

// Normal equations of t for the vertices of one part of the surface, with their D eliminated.
struct ScaleEquations {
  Mat3d matrix{};
  Vec3d right{0, 0, 0};
  void add(const std::vector<ReflectionSample>& of_vertex, const SampleNoise&);
};

// The estimate of t, and the covariance of its logarithms from the disagreement of the parts. t = 1 with a
// large covariance where there is no evidence.
LightScale light_scale(const std::vector<ScaleEquations>& places);

}  // namespace cei3d
