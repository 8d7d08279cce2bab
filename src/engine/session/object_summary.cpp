// SPDX-License-Identifier: Apache-2.0
#include "engine/session/object_summary.h"

#include <algorithm>
#include <cmath>

namespace cei3d {

namespace {

double spread_of(const std::vector<ViewExposure>& exposures) {
  double sum = 0;
  for (const ViewExposure& e : exposures)
    for (int c = 0; c < 3; ++c) sum += std::pow(std::log(double(e.factors[c])), 2) / 3;
  return exposures.empty() ? 0 : std::sqrt(sum / double(exposures.size()));
}

}  // namespace

ObjectSummary summary_of(const Device& device, const Scene& scene) {
  constexpr size_t kTwentieth = 20;
  ObjectSummary out;
  out.mean = scene.material.mean();
  out.explained = scene.explained;
  out.light_motion = scene.light_frame.motion;
  out.light_error = scene.light_error;
  out.refined_poses = scene.refined.poses.size();
  out.focal = scene.refined.focal;
  out.exposures = spread_of(scene.exposures);
  out.min_roughness = out.max_roughness = out.mean.roughness;
  out.metal_share = out.mean.metalness;
  out.varies = bool(scene.material.varying());
  if (!out.varies || !scene.surface) return out;
  const auto& surface = scene.shape_versions.empty() ? scene.surface : scene.shape_versions.front()->surface;
  const std::vector<Material> materials = scene.material.at(device, surface->mesh().positions);
  if (materials.empty()) return out;
  std::vector<float> roughness;
  float metals = 0;
  for (const Material& m : materials) {
    roughness.push_back(m.roughness);
    metals += m.metalness;
  }
  std::sort(roughness.begin(), roughness.end());
  out.metal_share = metals / float(materials.size());
  out.min_roughness = roughness[roughness.size() / kTwentieth];
  out.max_roughness = roughness[roughness.size() - 1 - roughness.size() / kTwentieth];
  return out;
}

}  // namespace cei3d
