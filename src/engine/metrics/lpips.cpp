// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/lpips.h"

#include <cmath>

#include "core/base/error.h"

namespace cei3d {

OnnxTensor image_tensor(const Image& rgb, float scale, float shift) {
  OnnxTensor t;
  t.shape = {1, 3, rgb.height, rgb.width};
  const size_t pixels = size_t(rgb.width) * rgb.height;
  t.data.resize(3 * pixels);
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c) t.data[c * pixels + i] = rgb.data[3 * i + c] * scale + shift;
  return t;
}

Lpips::Lpips(std::shared_ptr<const OnnxRuntime> runtime, const std::filesystem::path& file, int threads)
    : network_(std::move(runtime), file, threads), file_(file) {
  if (network_.inputs().size() != 2 || network_.outputs().empty())
    fail(
        "{} is not a network for LPIPS: it has {} inputs, and two images go in; see "
        "docs/evaluation.md.",
        file.string(), network_.inputs().size());
}

double Lpips::distance(const Image& a, const Image& b) const {
  if (a.width != b.width || a.height != b.height || a.channels != 3 || b.channels != 3 || a.empty())
    fail("Cannot compare an image of {} x {} x {} with one of {} x {} x {}.", a.width, a.height, a.channels,
         b.width, b.height, b.channels);
  const std::string& output = network_.outputs().front();
  const OnnxTensors out = network_.run(
      {{network_.inputs()[0], image_tensor(a, 2, -1)}, {network_.inputs()[1], image_tensor(b, 2, -1)}},
      {output});
  const std::vector<float>& value = out.at(output).data;
  if (value.size() != 1 || !std::isfinite(value[0]))
    fail(
        "{} is not a network for LPIPS: it answers with {} for a pair of images; see "
        "docs/evaluation.md.",
        file_.string(), value.size() == 1 ? "no finite number" : fmt::format("{} numbers", value.size()));
  return value[0];
}

}  // namespace cei3d
