// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/sam_memory.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/hash.h"

namespace cei3d {
namespace {

std::string name_of(const Image& image) {
  const std::string_view bytes(reinterpret_cast<const char*>(image.data.data()),
                               image.data.size() * sizeof(float));
  return fmt::format("{}x{} {}", image.width, image.height, content_hash(bytes));
}

}  // namespace

std::shared_ptr<const SamImage> EncodedImages::get(const Image& rgba, const Encode& encode) {
  const std::string name = name_of(rgba);
  const auto it =
      std::find_if(images_.begin(), images_.end(), [&](const auto& i) { return i.first == name; });
  auto image = it != images_.end() ? it->second : std::make_shared<const SamImage>(encode(rgba));
  if (it != images_.end()) images_.erase(it);
  images_.emplace_back(name, image);
  if (images_.size() > kMax) images_.pop_front();
  return image;
}

const Sam& SamMemory::network() {
  if (!network_) network_ = std::make_unique<const Sam>(folder_, threads_);
  return *network_;
}

std::shared_ptr<const SamImage> SamMemory::encoded(const Image& rgba) {
  const Sam& sam = network();
  return images_.get(rgba, [&](const Image& image) { return sam.encode(image); });
}

}  // namespace cei3d
