// SPDX-License-Identifier: Apache-2.0
// The textured object as it goes into a file, in whatever format.
#pragma once

#include <optional>
#include <string>

#include "engine/export/bake.h"
#include "engine/export/placement.h"
#include "engine/export/textured_mesh.h"

namespace cei3d {

enum class PictureKind { png, jpeg, webp };

// An encoded picture.
struct Picture {
  std::string name;  // "base_color.png"
  std::string bytes;
  PictureKind kind = PictureKind::png;

  const char* mime() const;
};

struct AssetPictures {
  Picture base_color;  // RGB, sRGB
  Picture orm;         // R: occlusion, G: roughness, B: metalness
  Picture normal;      // tangent space, y up
  // RGBA, of a specular strength s. RGB, sRGB: max(s, 0.5); alpha: min(2 s, 1). None: the same everywhere.
  std::optional<Picture> specular;
  float middle_specular = 0.5f;
};

// kind: of all but the normals, which a lossy picture would spoil: PNG, or lossless WebP.
AssetPictures encode(const Textures& textures, PictureKind kind);

// Some triangles of an object.
struct NamedTriangles {
  std::string name;
  std::vector<std::array<uint32_t, 3>> triangles;
};

struct Asset {
  std::string name;   // of the object in the file
  TexturedMesh mesh;  // capture frame
  // The mesh's triangles by part, those in no part under the object's own name; none of them is empty.
  std::vector<NamedTriangles> parts;
  AssetPictures pictures;
  Placement placement;
};

// Index that the mean specular strength stands for, F0 = 0.08 specular, for formats that know no other
// measure.
double index_of_refraction(const AssetPictures& pictures);

// Single channels as gray pictures, for formats without packed ones. name: "roughness", without suffix.
Picture gray_picture(const Image& image, int channel, const std::string& name);

}  // namespace cei3d
