// SPDX-License-Identifier: Apache-2.0
// Masks of the object in photographs whose poses are known and that have none.
// docs/method.md#masks-of-bare-photographs
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "engine/photos/photo_segmenter.h"
#include "engine/photos/sparse_points.h"

namespace cei3d {

struct PhotoClick {
  size_t view = 0;
  Vec2f pixel;         // of the photograph
  bool object = true;  // false: beside it
};

struct MaskRequest {
  std::span<const View> views;        // with sightings, without masks
  std::vector<PhotoClick> clicks;     // empty: the object is found by where the cameras look (split_points())
  std::filesystem::path first_masks;  // folder for the masks of the first round; those in it are used
  std::filesystem::path masks;        // folder for the result: NAME.png, white where the object is
};

// Works in two rounds. In the first one prompts are triangulated points that probably lie on the object, and
// points beside it; each mask corrects the scores of the points that it shows. In the second one prompts come
// from the volume that nearly all masks agree on (vote_on_masks()), and the network sees an enlarged section
// of the photograph; mask pixels outside of that volume are removed. Returns the names of photographs in
// which the object was not found; they have no mask. Errors: no prompts anywhere, unreadable photographs,
// interrupted.
std::vector<std::string> make_masks(const MaskRequest&, PhotoSegmenter&, double first, double last,
                                    Progress&);

}  // namespace cei3d
