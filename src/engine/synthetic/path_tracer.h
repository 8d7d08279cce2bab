// SPDX-License-Identifier: Apache-2.0
// Path tracer for synthetic scenes: the rendering integral with shadows and interreflections, unbiased up to
// the number of bounces. It shares only the reflectance formulas with the program's shading, and is therefore
// a check of it.
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
  int bounces = 3;  // maximum number of interreflections
};

struct BodyPoint {
  Vec3f position, normal;
  Material material;
  Vec3f albedo;  // linear
};
BodyPoint body_point(const SyntheticScene&, Vec3f position);

class PathTracer {
 public:
  explicit PathTracer(const SyntheticScene& scene) : scene_(scene), light_(scene.light) {}

  // Estimate, by one path, of the linear radiance from the point to the viewer.
  Vec3f radiance(BodyPoint point, Vec3f to_viewer, SampleSequence& samples) const;

 private:
  Vec3f direct(const BodyPoint&, const Scattering&, float pick, Vec2<float> u) const;

  const SyntheticScene& scene_;
  LightSampler light_;
};

}  // namespace cei3d
