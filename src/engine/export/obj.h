// SPDX-License-Identifier: Apache-2.0
// The textured object as Wavefront OBJ with a material library.
#pragma once

#include <vector>

#include "core/base/file.h"
#include "engine/export/asset.h"

namespace cei3d {

// NAME.obj, NAME.mtl and NAME_<picture>. Materials by the keys for physically based ones (Pr, Pm, norm). The
// format has no place for a placement: with in_capture_frame the vertices stay in the capture's frame, else
// they are placed.
std::vector<FileBytes> obj_files(const Asset& asset, const Textures& textures,
                                 const std::filesystem::path& path, bool in_capture_frame);

}  // namespace cei3d
