// SPDX-License-Identifier: Apache-2.0
// How strong a light is, by what dielectrics reflect of it: generalized least squares.
// (docs/method.md#the-color-of-the-light)
#pragma once

#include <algorithm>
#include <vector>

#include "core/math/vec.h"
#include "model/light/light_color.h"

namespace cei3d {

// A sample of a dielectric vertex: color = D diffuse + t reflected, channel by channel, D the vertex' own.
struct ReflectionSample {
  Vec3f weight;  // SplitRow::weight
  Vec3f diffuse, reflected, color;
};

// How far samples are from that. Besides errors of each channel the diffuse light varies as a whole, in the
// color of the surface: pixels that show a neighbor, another exposure, a light that moved. What varies in
// that color is no reflection.
struct SampleNoise {
  double color = 1;    // variance of a channel, display units
  double diffuse = 0;  // variance of the strength of the diffuse light, relative
};

// D of a vertex for t = 1, at least 0.
Vec3f diffuse_of(const std::vector<ReflectionSample>& of_vertex);

// Sums over vertices that give the noise.
class NoiseSums {
 public:
  void add(const std::vector<ReflectionSample>& of_vertex);
  SampleNoise noise() const;
  // Mean square of what the reflections vary within the vertices, per channel, display units.
  Vec3d reflected() const { return reflected_ / double(std::max<size_t>(samples_, 1)); }

 private:
  Vec3d reflected_{0, 0, 0};
  double along_ = 0, across_ = 0, diffuse_ = 0;  // squared errors along D and across it, squares of D
  size_t samples_ = 0;
};

// The normal equations of t for the vertices of a place, their D eliminated.
struct ScaleEquations {
  Mat3d matrix{};
  Vec3d right{0, 0, 0};
  void add(const std::vector<ReflectionSample>& of_vertex, const SampleNoise&);
};

// t, and the covariance of its logarithms: how far the places disagree. 1 and unknown where they say nothing.
LightScale light_scale(const std::vector<ScaleEquations>& places);

}  // namespace cei3d
