// SPDX-License-Identifier: Apache-2.0
// What draws the eye in a photograph, by a network such as U2-Net [Qin et al. 2020]: mostly the object, and
// sometimes what it stands on.
#pragma once

#include <filesystem>
#include <optional>

#include "core/image/image.h"
#include "core/infer/onnx.h"

namespace cei3d {

class Saliency {
 public:
  // folder: saliency.onnx, which takes [1, 3, 320, 320] and whose first output is [1, 1, 320, 320], and,
  // unless the system has one, the runtime; as installed_sam(). None: there is no such file. threads: 0: all
  // cores. Error: it is not such a network.
  static std::optional<Saliency> find(const std::filesystem::path& folder, int threads = 0);

  // rgba: linear. Returns the whole image in 320 x 320 pixels, 1 channel, from 0 to 1.
  Image map(const Image& rgba) const;

 private:
  explicit Saliency(std::unique_ptr<OnnxModel> network) : network_(std::move(network)) {}
  std::unique_ptr<OnnxModel> network_;
};

}  // namespace cei3d
