// SPDX-License-Identifier: Apache-2.0
// The paper's material: one for the object, besides the albedo. [paper eq. 13, 14]
#pragma once

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

struct SgMaterial {
  float sharpness = 110;        // of the lobe of normals, > 0
  Vec3f amplitude{17, 17, 17};  // its peak; sharpness / (2 pi) makes it a distribution
  float roughness = 0.37f;      // of the shadowing alone, [0, 1]
  float specular = 0.22f;       // reflectance along the normal, [0, 1]: the paper's specular albedo
  float metalness = 0;          // [0, 1]
};

// A lobe of this sharpness stands for GGX of this roughness, within the range of a material. [Wang et al.
// 2009]
float roughness_of_sharpness(float sharpness);

// The paper's material for a material of the shading model: its lobe is the one that the roughness stands
// for.
SgMaterial sg_material_of(const Material&);
// The material of the shading model that comes nearest: the width of the lobe, and as much reflection along
// the normal as a dielectric can have.
Material nearest_material(const SgMaterial&);

}  // namespace cei3d
