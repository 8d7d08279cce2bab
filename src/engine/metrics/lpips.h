// SPDX-License-Identifier: Apache-2.0
// LPIPS, a learned perceptual distance of two images, by a network that the user supplies. [Zhang et al.
// 2018]
#pragma once

#include <filesystem>
#include <memory>

#include "core/image/image.h"
#include "core/infer/onnx.h"

namespace cei3d {

class Lpips {
 public:
  // file: an ONNX network with two inputs, both [1, 3, H, W] of display-encoded RGB in [-1, 1], and one
  // number as output, the distance (docs/evaluation.md). threads: 0: all cores. Error: no such network.
  Lpips(std::shared_ptr<const OnnxRuntime>, const std::filesystem::path& file, int threads = 0);

  // 0 for equal images. a, b: RGB of one size, values in [0, 1], display-encoded. Errors: sizes differ, the
  // network rejects them or returns something else.
  double distance(const Image& a, const Image& b) const;

 private:
  OnnxModel network_;
  std::filesystem::path file_;
};

// [1, 3, H, W] tensor of an image with 3 channels: value * scale + shift.
OnnxTensor image_tensor(const Image& rgb, float scale, float shift);

}  // namespace cei3d
