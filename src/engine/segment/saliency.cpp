// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/saliency.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr int kSide = 320;
constexpr float kMean[3] = {0.485f, 0.456f, 0.406f}, kDeviation[3] = {0.229f, 0.224f, 0.225f};

// The whole image in the sides of the network, without regard to its shape: so the network was trained.
OnnxTensor input_of(const Image& rgba) {
  const int n = std::max(1, std::min(rgba.width, rgba.height) / kSide);
  const Image small = scaled_to(n > 1 ? downscale(rgba, n) : rgba, kSide, kSide);
  OnnxTensor t{{1, 3, kSide, kSide}, std::vector<float>(size_t(3) * kSide * kSide)};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int c = 0; c < 3; ++c) {
        const float srgb = srgb_from_linear(std::clamp(small.at(x, y)[c], 0.0f, 1.0f));
        t.data[(size_t(c) * kSide + size_t(y)) * kSide + size_t(x)] = (srgb - kMean[c]) / kDeviation[c];
      }
  return t;
}

}  // namespace

std::optional<Saliency> Saliency::find(const std::filesystem::path& folder, int threads) {
  const std::filesystem::path file = folder / "saliency.onnx";
  if (!std::filesystem::exists(file)) return std::nullopt;
  auto network = std::make_unique<OnnxModel>(std::make_shared<OnnxRuntime>(folder), file, threads);
  if (network->inputs().size() != 1 || network->outputs().empty())
    fail("{} is not a network of saliency, with one image as its input; `./run sam` installs one.",
         file.string());
  return Saliency(std::move(network));
}

// The output is stretched to all of [0, 1], as the network was made to be used.
Image Saliency::map(const Image& rgba) const {
  const std::string name = network_->outputs()[0];
  const OnnxTensors out = network_->run({{network_->inputs()[0], input_of(rgba)}}, {name});
  Image map(kSide, kSide, 1);
  const std::vector<float>& values = out.at(name).data;
  if (values.size() != map.data.size())
    fail("The network of saliency returns {} values in place of {} x {}.", values.size(), kSide, kSide);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const float range = std::max(*high - *low, 1e-6f);
  for (size_t i = 0; i < values.size(); ++i) map.data[i] = (values[i] - *low) / range;
  return map;
}

}  // namespace cei3d
