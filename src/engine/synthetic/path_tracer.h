// SPDX-License-Identifier: Apache-2.0
// What a point of a synthetic scene sends to the camera, by path tracing: the rendering integral with shadows
// and light that is reflected from one place of the surface to another, unbiased up to the number of bounces.
// It shares nothing with the program's shading but the reflectance itself, and so is a check of it.
#pragma once

#include <vector>

#include "engine/synthetic/finishes.h"
#include "engine/synthetic/lamps.h"
#include "engine/synthetic/sample_sequence.h"
#include "engine/synthetic/scattering.h"
#include "engine/synthetic/shapes.h"

namespace cei3d {

struct SyntheticScene {
  Shape shape;
  std::vector<Finish> finishes;  // of shape.regions
  SgMixture light;
  Diffuse diffuse = Diffuse::burley;
  int bounces = 3;  // how often light may go from one place of the surface to another
};

struct BodyPoint {
  Vec3f position, normal;
  Material material;
  Vec3f base_color;  // linear
};
BodyPoint body_point(const SyntheticScene&, Vec3f position);

class PathTracer {
 public:
  explicit PathTracer(const SyntheticScene& scene) : scene_(scene), light_(scene.light) {}

  // One path's estimate of the linear radiance that the point sends to the viewer.
  Vec3f radiance(BodyPoint point, Vec3f to_viewer, SampleSequence& samples) const;

 private:
  Vec3f direct(const BodyPoint&, const Scattering&, float pick, Vec2<float> u) const;

  const SyntheticScene& scene_;
  LightSampler light_;
};

}  // namespace cei3d
