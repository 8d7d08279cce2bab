// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/photo_blocks.h"

#include <algorithm>
#include <cmath>

namespace cei3d {

namespace {

bool on_object(const Pixel& p) { return p.srgba[3] == 255; }

size_t count_on_object(const PixelStore& store) {
  return size_t(std::count_if(store.pixels().begin(), store.pixels().end(), on_object));
}

}  // namespace

PhotoBlocks::PhotoBlocks(const PixelStore& store, int size)
    : store_(store), size_(size), count_(count_on_object(store) / size_t(size * size)) {
  for (const Camera& c : store.cameras()) cameras_.push_back(size == 1 ? c : scaled(c, size));
  const std::vector<Pixel>& pixels = store.pixels();
  for (size_t v = 0; v <= cameras_.size(); ++v)
    first_.push_back(size_t(
        std::partition_point(pixels.begin(), pixels.end(), [&](const Pixel& p) { return p.view < v; }) -
        pixels.begin()));
}

std::vector<PhotoBlocks::Block> PhotoBlocks::of_view(size_t view) const {
  const Camera& camera = cameras_[view];
  struct Sum {
    Vec3f color{0, 0, 0};
    int pixels = 0;
    uint8_t clipped = 0;
  };
  std::vector<Sum> sums(size_t(camera.width) * size_t(camera.height));
  for (size_t i = first_[view]; i < first_[view + 1]; ++i) {
    const Pixel& p = store_.pixels()[i];
    const int x = p.x / size_, y = p.y / size_;
    if (!on_object(p) || x >= camera.width || y >= camera.height) continue;
    Sum& sum = sums[size_t(y) * size_t(camera.width) + size_t(x)];
    sum.color += store_.radiance(i);
    sum.clipped |= store_.clipped(i);
    ++sum.pixels;
  }
  std::vector<Block> out;
  for (size_t i = 0; i < sums.size(); ++i)
    if (const Sum& sum = sums[i]; sum.pixels == size_ * size_)
      out.push_back({uint16_t(i % size_t(camera.width)), uint16_t(i / size_t(camera.width)),
                     sum.color / float(sum.pixels), sum.clipped});
  return out;
}

int PhotoBlocks::size_for(const PixelStore& store, size_t max_blocks) {
  const double size =
      std::ceil(std::sqrt(double(count_on_object(store)) / double(std::max<size_t>(max_blocks, 1))));
  return int(std::clamp(size, 1.0, double(kLargest)));
}

}  // namespace cei3d
