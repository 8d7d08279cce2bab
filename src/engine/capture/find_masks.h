// SPDX-License-Identifier: Apache-2.0
// Mask files by the habits of the programs that write them.
#pragma once

#include <filesystem>

namespace cei3d {

// The mask of an image below `root`; empty if there is none. Looked for in masks/ and mask/, beside the
// folder of the image or below root, with the image's sub-folder or without, and beside the image: NAME.png,
// NAME.jpg.png, NAME.mask.png, NAME.jpg.mask.png, NAME_mask.png; and dynamic_mask_NAME.png beside it.
std::filesystem::path find_mask(const std::filesystem::path& root, const std::filesystem::path& image);

}  // namespace cei3d
