// SPDX-License-Identifier: Apache-2.0
// The textured object as USDZ, as phones show it in the room. [Pixar USDZ]
#pragma once

#include <string>
#include <vector>

#include "core/base/file.h"
#include "engine/export/asset.h"

namespace cei3d {

// A package of a text layer and the pictures. Y up, meters, as the placement says.
std::string encode_usdz(const Asset& asset);

// Files one after the other, not compressed, the bytes of each at a multiple of 64 from the start: a ZIP
// archive that can be mapped into memory. paths: names in the archive. Error: 4 GB or more.
std::string stored_zip(std::span<const FileBytes> files);

}  // namespace cei3d
