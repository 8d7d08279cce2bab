// SPDX-License-Identifier: Apache-2.0
// Segment Anything, as an encoder (once a picture, about a second) and a decoder (once a set of prompts).
//
// Two ONNX files. The encoder takes [1, 3, 1024, 1024] and gives [1, 256, 64, 64]. The decoder takes
// image_embeddings, point_coords, point_labels, mask_input and has_mask_input (and orig_im_size, where it
// asks for that) and gives low_res_masks, log-odds over the frame at a quarter of its resolution, and
// iou_predictions.
#pragma once

#include <filesystem>
#include <span>

#include "core/image/image.h"
#include "core/infer/onnx.h"
#include "core/math/vec.h"

namespace cei3d {

// Where `./run sam` puts the networks and the runtime: `sam` beside the program's folder (build/sam), in it,
// or in share/cei3d beside it. The first of these if there is none.
std::filesystem::path installed_sam();

// A picture as the decoder wants it. The frame of 1024 pixels shows the object only, enlarged: small parts
// get as much of the network's resolution as can be.
struct SamPicture {
  OnnxTensor embedding;
  int width = 0, height = 0;  // of the picture
  int x0 = 0, y0 = 0;         // where the frame begins in it
  float scale = 1;            // frame pixels per picture pixel
};

class Sam {
 public:
  // folder: encoder.onnx, decoder.onnx and, unless the system has one, the runtime. threads: 0: every core.
  // Error: something is missing, with what to do.
  explicit Sam(const std::filesystem::path& folder, int threads = 0);

  // rgba: linear, straight alpha; the object is where alpha > 0.5.
  SamPicture encode(const Image& rgba) const;

  // Continuous pixel positions of the picture. Returns one channel of its size: log-odds; strongly negative
  // outside the frame.
  Image mask(const SamPicture&, std::span<const Vec2f> positive, std::span<const Vec2f> negative) const;

 private:
  std::shared_ptr<const OnnxRuntime> runtime_;
  OnnxModel encoder_, decoder_;
};

// The frame's contents before they are normalized: RGB, sRGB in [0, 255], of `scale` times the size of the
// box, its longest side 1024. Exposed for tests.
struct SamFrame {
  Image rgb;
  int x0 = 0, y0 = 0;
  float scale = 1;
};
SamFrame sam_frame(const Image& rgba);

}  // namespace cei3d
