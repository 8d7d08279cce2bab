// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/sam.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/system.h"
#include "core/math/bilinear.h"

namespace cei3d {
namespace {

constexpr int kFrame = 1024;
constexpr int kLowRes = 256;
constexpr float kOutside = -20;  // log-odds outside the frame
constexpr float kMean[3] = {123.675f, 116.28f, 103.53f}, kDeviation[3] = {58.395f, 57.12f, 57.375f};

std::filesystem::path network(const std::filesystem::path& folder, const char* name) {
  const std::filesystem::path file = folder / name;
  if (!std::filesystem::exists(file))
    fail(
        "The segmentation network {} is missing. `./run sam` installs it; the segmenter that grows parts "
        "needs none.",
        file.string());
  return file;
}

// The normalized frame, with zeros beside the image.
OnnxTensor encoder_input(const Image& rgb) {
  OnnxTensor t{{1, 3, kFrame, kFrame}, std::vector<float>(size_t(3) * kFrame * kFrame, 0.0f)};
  for (int y = 0; y < std::min(rgb.height, kFrame); ++y)
    for (int x = 0; x < std::min(rgb.width, kFrame); ++x)
      for (int c = 0; c < 3; ++c)
        t.data[(size_t(c) * kFrame + y) * kFrame + x] = (rgb.at(x, y)[c] - kMean[c]) / kDeviation[c];
  return t;
}

OnnxTensors decoder_input(const SamImage& image, std::span<const Vec2f> positive,
                          std::span<const Vec2f> negative, const std::optional<std::array<Vec2f, 2>>& box) {
  OnnxTensor coords, labels;
  const auto add = [&](Vec2f p, float label) {
    // The network itself adds half a frame pixel.
    coords.data.push_back((p.x - image.x0) * image.scale - 0.5f);
    coords.data.push_back((p.y - image.y0) * image.scale - 0.5f);
    labels.data.push_back(label);
  };
  for (Vec2f p : positive) add(p, 1);
  for (Vec2f p : negative) add(p, 0);
  if (box) {
    add((*box)[0], 2);
    add((*box)[1], 3);
  } else {
    coords.data.insert(coords.data.end(), {0, 0});  // points without a box end with a filler
    labels.data.push_back(-1);
  }
  const auto n = int64_t(labels.data.size());
  coords.shape = {1, n, 2};
  labels.shape = {1, n};
  return {{"image_embeddings", image.embedding},
          {"point_coords", coords},
          {"point_labels", labels},
          {"mask_input", {{1, 1, kLowRes, kLowRes}, std::vector<float>(size_t(kLowRes) * kLowRes, 0.0f)}},
          // Its full-size masks are not used: small.
          {"has_mask_input", {{1}, {0}}},
          {"orig_im_size", {{2}, {64, 64}}}};
}

// For several prompts mask 0 is the answer. For a single click there are three masks (part, whole,
// surroundings): the one with the best predicted quality is taken.
size_t best_mask(const OnnxTensor& quality, size_t prompts) {
  if (prompts > 1 || quality.data.size() < 2) return 0;
  return size_t(std::max_element(quality.data.begin() + 1, quality.data.end()) - quality.data.begin());
}

// Smooths the dotted pattern of a few pixels that small networks produce.
void blur(std::vector<float>& plane) {
  constexpr float kKernel[4] = {0.2660f, 0.2130f, 0.1095f, 0.0361f};  // Gaussian of 1.5 pixels, cut at 3
  std::vector<float> rows(plane.size());
  const auto pass = [&](const std::vector<float>& in, std::vector<float>& out, int dx, int dy) {
    const auto at = [&](int x, int y) {
      return in[size_t(std::clamp(y, 0, kLowRes - 1)) * kLowRes + std::clamp(x, 0, kLowRes - 1)];
    };
    for (int y = 0; y < kLowRes; ++y) {
      for (int x = 0; x < kLowRes; ++x) {
        float sum = kKernel[0] * at(x, y), weight = kKernel[0];
        for (int k = 1; k < 4; ++k) {
          sum += kKernel[k] * (at(x - k * dx, y - k * dy) + at(x + k * dx, y + k * dy));
          weight += 2 * kKernel[k];
        }
        out[size_t(y) * kLowRes + x] = sum / weight;
      }
    }
  };
  pass(plane, rows, 1, 0);
  pass(rows, plane, 0, 1);
}

// Bilinear between the centers of the low-resolution pixels.
Image to_image(const std::vector<float>& plane, const SamImage& p) {
  Image out(p.width, p.height, 1, kOutside);
  constexpr float kStep = float(kFrame) / kLowRes;
  const auto last = float(kLowRes - 1);
  for (int y = 0; y < p.height; ++y) {
    const float v = (float(y) - p.y0 + 0.5f) * p.scale / kStep - 0.5f;
    for (int x = 0; x < p.width; ++x) {
      const float u = (float(x) - p.x0 + 0.5f) * p.scale / kStep - 0.5f;
      if (u < -0.5f || v < -0.5f || u > last + 0.5f || v > last + 0.5f) continue;
      const float cu = std::clamp(u, 0.0f, last - 0.001f), cv = std::clamp(v, 0.0f, last - 0.001f);
      const int i = int(cu), j = int(cv);
      const float fu = cu - float(i), fv = cv - float(j);
      const float* a = &plane[size_t(j) * kLowRes + i];
      const float* b = a + kLowRes;
      *out.at(x, y) = bilinear({a[0], a[1], b[0], b[1]}, fu, fv);
    }
  }
  return out;
}

}  // namespace

std::filesystem::path installed_sam() {
  std::error_code ignored;
  const std::filesystem::path program = program_file().parent_path();
  const std::filesystem::path first = program.parent_path() / "sam";
  for (const auto& folder : {first, program / "sam", program.parent_path() / "share/cei3d/sam"})
    if (std::filesystem::exists(folder / "encoder.onnx", ignored)) return folder;
  return first;
}

SamImage of_whole(SamImage section, int width, int height, const PixelBox& box, double scale) {
  SamImage image = std::move(section);
  image.width = width;
  image.height = height;
  image.x0 = float(box.x0 + image.x0 / scale);
  image.y0 = float(box.y0 + image.y0 / scale);
  image.scale *= float(scale);
  return image;
}

Sam::Sam(const std::filesystem::path& folder, int threads)
    : runtime_(std::make_shared<OnnxRuntime>(folder)),
      encoder_(runtime_, network(folder, "encoder.onnx"), threads),
      decoder_(runtime_, network(folder, "decoder.onnx"), threads) {
  if (encoder_.inputs().size() != 1 || encoder_.outputs().empty())
    fail("{} is not the encoder of a Segment Anything pair; `./run sam` installs one.",
         (folder / "encoder.onnx").string());
}

SamImage Sam::encode(const Image& rgba) const {
  const SamFrame frame = sam_frame(rgba);
  const std::string& output = encoder_.outputs().front();
  OnnxTensors out = encoder_.run({{encoder_.inputs().front(), encoder_input(frame.rgb)}}, {output});
  return {std::move(out.at(output)), rgba.width, rgba.height, frame.x0, frame.y0, frame.scale};
}

Image Sam::mask(const SamImage& image, std::span<const Vec2f> positive, std::span<const Vec2f> negative,
                const std::optional<std::array<Vec2f, 2>>& box) const {
  const OnnxTensors out =
      decoder_.run(decoder_input(image, positive, negative, box), {"low_res_masks", "iou_predictions"});
  const OnnxTensor& masks = out.at("low_res_masks");
  constexpr size_t kPlane = size_t(kLowRes) * kLowRes;
  const size_t best = best_mask(out.at("iou_predictions"), positive.size() + negative.size() + (box ? 2 : 0));
  if (masks.data.size() < (best + 1) * kPlane)
    fail(
        "The segmentation decoder gives masks of another size than {0} x {0}; `./run sam` installs one that "
        "fits.",
        kLowRes);
  std::vector<float> plane(masks.data.begin() + long(best * kPlane),
                           masks.data.begin() + long((best + 1) * kPlane));
  blur(plane);
  return to_image(plane, image);
}

}  // namespace cei3d
