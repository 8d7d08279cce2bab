// SPDX-License-Identifier: Apache-2.0
// The segmentation network and the images that it has encoded last. Encoding an image takes most of a second,
// decoding the mask of a click a few hundredths of one: repeated clicks on an image only run the decoder.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "engine/segment/sam.h"

namespace cei3d {

// The last kMax encoded images, 4 MB each, known by their pixels: whatever changes what a view shows makes
// another image.
class EncodedImages {
 public:
  static constexpr size_t kMax = 32;
  using Encode = std::function<SamImage(const Image& rgba)>;
  // encode: called when the image is not there.
  std::shared_ptr<const SamImage> get(const Image& rgba, const Encode& encode);

 private:
  // By the hash of the image; the last used one last.
  std::deque<std::pair<std::string, std::shared_ptr<const SamImage>>> images_;
};

class SamMemory {
 public:
  // folder: of networks and runtime, which are loaded when they are first used: installed_sam(), or the
  // user's own. threads: of the network; 0: all cores.
  explicit SamMemory(std::filesystem::path folder, int threads = 0)
      : folder_(std::move(folder)), threads_(threads) {}

  // Error: no network, with what to do.
  const Sam& network();
  std::shared_ptr<const SamImage> encoded(const Image& rgba);

 private:
  std::filesystem::path folder_;
  int threads_;
  std::unique_ptr<const Sam> network_;
  EncodedImages images_;
};

}  // namespace cei3d
