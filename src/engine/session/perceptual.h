// SPDX-License-Identifier: Apache-2.0
// LPIPS and FID, if the user names networks for them.
#pragma once

#include <memory>
#include <optional>

#include "engine/metrics/fid.h"
#include "engine/metrics/lpips.h"
#include "engine/session/requests.h"

namespace cei3d {

class Perceptual {
 public:
  // Errors: a file that is no such network, no ONNX Runtime.
  explicit Perceptual(const NetworkFiles&);

  // a, b: RGB of one size, display-encoded.
  std::optional<double> distance(const Image& a, const Image& b) const;
  void add(FeatureSet&, const Image& rgb) const;  // adds its features, if there is a network
  // None without a network. Error: fewer than two images.
  std::optional<double> frechet(const FeatureSet& a, const FeatureSet& b) const;

 private:
  std::unique_ptr<Lpips> lpips_;
  std::unique_ptr<FeatureNetwork> features_;
};

}  // namespace cei3d
