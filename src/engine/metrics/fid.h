// SPDX-License-Identifier: Apache-2.0
// Frechet inception distance (FID) between two sets of images: the Frechet distance between Gaussians fitted
// to their features, which a network that the user supplies computes. [Heusel et al. 2017]
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/infer/onnx.h"

namespace cei3d {

// Features of a set of images.
struct FeatureSet {
  size_t dimensions = 0;
  std::vector<float> rows;  // #images x dimensions

  size_t size() const { return dimensions ? rows.size() / dimensions : 0; }
  void add(const std::vector<float>& row);  // error: of another length than those before
};

class FeatureNetwork {
 public:
  static constexpr int kSize = 299;

  // file: an ONNX network with one input, [1, 3, 299, 299] of display-encoded RGB in [0, 1]; its first output
  // is the features, [1, D] or [1, D, 1, 1] (docs/evaluation.md). threads: 0: all cores.
  FeatureNetwork(std::shared_ptr<const OnnxRuntime>, const std::filesystem::path& file, int threads = 0);

  // rgb: values in [0, 1], display-encoded, of any size. Error: the network rejects it or returns something
  // else.
  std::vector<float> features(const Image& rgb) const;

 private:
  OnnxModel network_;
  std::filesystem::path file_;
};

// Bilinear between pixel centers, as for most published figures; clamped at the border.
Image resized_for_features(const Image& rgb, int width, int height);

// |m1 - m2|^2 + tr(S1 + S2 - 2 (S1 S2)^(1/2)) of the sets' means and unbiased covariances; >= 0. Biased
// upwards for few images: compare sets of the same size only. Errors: fewer than two images in a set, sets of
// different networks.
double frechet_distance(const FeatureSet& a, const FeatureSet& b);

}  // namespace cei3d
