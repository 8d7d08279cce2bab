// SPDX-License-Identifier: Apache-2.0
// The object's pixels of the training photographs, one or a square block of several at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/camera.h"
#include "engine/reconstruct/pixels.h"

namespace cei3d {

class PhotoBlocks {
 public:
  struct Block {
    uint16_t x, y;         // column and row, in blocks
    Vec3f color{0, 0, 0};  // linear, mean of its pixels
    uint8_t clipped = 0;   // bit c: channel c of a pixel is (PixelStore::clipped)
  };
  static constexpr int kLargest = 8;

  // size: side of a block in pixels. The pixels must outlive the object.
  PhotoBlocks(const PixelStore&, int size);
  // The smallest size for which there are at most about that many blocks.
  static int size_for(const PixelStore&, size_t max_blocks);

  const std::vector<Camera>& cameras() const { return cameras_; }  // of images whose pixels are the blocks
  std::vector<Block> of_view(size_t view) const;                   // those wholly on the object, row by row
  size_t count() const { return count_; }                          // about

 private:
  const PixelStore& store_;
  int size_;
  std::vector<Camera> cameras_;
  std::vector<size_t> first_;  // of each view, first pixel; then the number of pixels
  size_t count_ = 0;
};

}  // namespace cei3d
