// SPDX-License-Identifier: Apache-2.0
// Color profiles of images (ICC), by Little CMS.
#pragma once

#include <string>

#include "core/image/image.h"

namespace cei3d {

// The ICC profile in a JPEG; empty if there is none.
std::string jpeg_profile(const std::string& bytes);

enum class ProfileKind {
  srgb,     // by its description
  other,    // of RGB images
  unusable  // damaged, or of other images
};
ProfileKind profile_kind(const std::string& profile);

// Linear, with sRGB primaries. image: 3 or 4 channels as stored, [0, 1]; alpha is kept. Colors that sRGB does
// not have keep values below 0 as 0. profile: of the kind `other`.
Image linear_by_profile(Image image, const std::string& profile);

}  // namespace cei3d
