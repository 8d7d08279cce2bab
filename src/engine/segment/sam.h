// SPDX-License-Identifier: Apache-2.0
// Segment Anything [Kirillov et al. 2023] as an encoder (once per image, about a second) and a decoder (once
// per set of prompts).
//
// Two ONNX files. The encoder takes [1, 3, 1024, 1024] and returns [1, 256, 64, 64]. The decoder takes
// image_embeddings, point_coords, point_labels, mask_input and has_mask_input (and orig_im_size if it has
// that input) and returns low_res_masks, log-odds over the frame at a quarter of its resolution, and
// iou_predictions.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>

#include "core/image/image.h"
#include "core/infer/onnx.h"
#include "core/math/pixel_box.h"
#include "core/math/vec.h"

namespace cei3d {

// Folder into which `./run sam` puts networks and runtime: `sam` beside the program's folder (build/sam),
// inside it, or in share/cei3d beside it. Returns the first that exists, else the first.
std::filesystem::path installed_sam();

// An image as the decoder needs it. The frame of 1024 pixels shows only the object, enlarged, so that small
// parts get as much resolution as possible.
struct SamImage {
  OnnxTensor embedding;
  int width = 0, height = 0;  // of the image
  float x0 = 0, y0 = 0;       // where the frame begins in it
  float scale = 1;            // frame pixels per image pixel
};

// For an image of that size, of which only a section (`box`) was encoded, at `scale` pixels per pixel.
SamImage of_whole(SamImage section, int width, int height, const PixelBox& box, double scale);

class Sam {
 public:
  // folder: encoder.onnx, decoder.onnx and, unless the system has one, the runtime. threads: 0: all cores.
  // Error: something is missing, with what to do.
  explicit Sam(const std::filesystem::path& folder, int threads = 0);

  // rgba: linear, straight alpha; the object is where alpha > 0.5.
  SamImage encode(const Image& rgba) const;

  // positive, negative: continuous pixel positions in the image. box: opposite corners of a box around the
  // whole thing, where that is known. Returns log-odds, 1 channel of the image's size; strongly negative
  // outside the frame.
  Image mask(const SamImage&, std::span<const Vec2f> positive, std::span<const Vec2f> negative,
             const std::optional<std::array<Vec2f, 2>>& box = {}) const;

 private:
  std::shared_ptr<const OnnxRuntime> runtime_;
  OnnxModel encoder_, decoder_;
};

// The frame's contents before normalization: RGB, sRGB in [0, 255], `scale` times the size of the box, its
// longest side 1024. Exposed for tests.
struct SamFrame {
  Image rgb;
  float x0 = 0, y0 = 0;
  float scale = 1;
};
SamFrame sam_frame(const Image& rgba);

}  // namespace cei3d
