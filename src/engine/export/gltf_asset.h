// SPDX-License-Identifier: Apache-2.0
// The textured object as glTF 2.0.
#pragma once

#include <vector>

#include "core/base/file.h"
#include "engine/export/asset.h"

namespace cei3d {

// Everything in one file. Named parts are nodes of their own below the object's. One material: base color,
// metallic-roughness with occlusion, tangent-space normals; a specular strength other than 0.5 as
// KHR_materials_specular; WebP pictures by EXT_texture_webp. Vertices stay in the capture
// frame; the node holds the placement.
std::string encode_glb(const Asset& asset);

// NAME.gltf with NAME.bin and NAME_<picture> beside it.
std::vector<FileBytes> gltf_files(const Asset& asset, const std::filesystem::path& path);

}  // namespace cei3d
