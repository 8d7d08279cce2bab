// SPDX-License-Identifier: Apache-2.0
// Finds the object in one photograph: by a network and points on it, by a photograph without it, or, in
// tests, by the truth.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/image/image.h"
#include "core/math/pixel_box.h"
#include "engine/segment/prompts.h"
#include "model/scene/view.h"

namespace cei3d {

class PhotoSegmenter {
 public:
  virtual ~PhotoSegmenter() = default;
  // Log-odds of belonging to the object for the pixels of a section of the photograph: 1 channel of its size.
  // prompts: pixel positions in the photograph, at least one positive. around: where the object is about;
  // none: not known.
  virtual Image log_odds(const View& view, const PixelBox& section, const Prompts& prompts,
                         const std::optional<PixelBox>& around) = 0;
  // What draws the eye: 1 channel, [0, 1], the whole photograph at any size and shape. None: not known.
  virtual std::optional<Image> saliency(const View&) { return std::nullopt; }
};

// Segment Anything, and a network of saliency where there is one. folder: as Sam() and Saliency want it.
std::unique_ptr<PhotoSegmenter> sam_segmenter(const std::filesystem::path& folder, int threads);

// plate: a photograph of the same size without the object, from the same place, in the same light. What
// differs from it belongs to the object. Prompts are not needed. Error: it cannot be read.
std::unique_ptr<PhotoSegmenter> plate_segmenter(const std::filesystem::path& plate);

// The pixels of the photograph's file: RGBA, linear, alpha 1.
Image load_photo(const View& view);

}  // namespace cei3d
