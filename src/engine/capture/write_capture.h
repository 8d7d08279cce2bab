// SPDX-License-Identifier: Apache-2.0
// Writes a capture as transforms.json, images/ and masks/, in the layout of nerfstudio.
#pragma once

#include <filesystem>

#include "model/scene/view.h"

namespace cei3d {

// Images and masks are copied as they are; masks that are dark where the object is are inverted. Views with a
// lens that the layout cannot express are written undistorted. Splits are kept as lists of file names.
// Errors: the folder exists and is not empty; a file cannot be read or written.
void write_capture(const Capture& capture, const std::filesystem::path& folder);

}  // namespace cei3d
