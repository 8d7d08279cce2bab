// SPDX-License-Identifier: Apache-2.0
#include "engine/session/perceptual.h"

#include "engine/segment/sam.h"

namespace cei3d {

Perceptual::Perceptual(const NetworkFiles& files) {
  if (files.lpips.empty() && files.fid.empty()) return;
  const auto runtime = std::make_shared<const OnnxRuntime>(installed_sam());
  if (!files.lpips.empty()) lpips_ = std::make_unique<Lpips>(runtime, files.lpips);
  if (!files.fid.empty()) features_ = std::make_unique<FeatureNetwork>(runtime, files.fid);
}

std::optional<double> Perceptual::distance(const Image& a, const Image& b) const {
  if (!lpips_) return std::nullopt;
  return lpips_->distance(a, b);
}

void Perceptual::add(FeatureSet& set, const Image& rgb) const {
  if (features_) set.add(features_->features(rgb));
}

std::optional<double> Perceptual::frechet(const FeatureSet& a, const FeatureSet& b) const {
  if (!features_) return std::nullopt;
  return frechet_distance(a, b);
}

}  // namespace cei3d
