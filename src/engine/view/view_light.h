// SPDX-License-Identifier: Apache-2.0
// A light as maps over the sphere, and what shading needs besides, as packs (engine/view/pack.h) for
// src/web/renderer.js. Maps are octahedral: the outer nodes lie on the border of the square.
#pragma once

#include <string>

#include "core/compute/device.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

// Roughnesses of the reflection maps, in geometric progression.
inline constexpr int kReflectionLevels = 12;
float reflection_level_roughness(int level);
float reflection_level(float roughness);  // inverse, as a share of the range, [0, 1]

// "light": irradiance u32 [side^2, 1], over the normal, without occlusion; reflection u32 [levels side^2, 1],
// the light averaged over the round reflection lobe of every level's roughness, over its axis; all with a
// shared exponent. Head: irradiance_side, reflection_side, reflection_levels.
std::string view_light(const Device&, const SgMixture&);

// "tables": what shading reads by the cosine of normal and viewer (columns; at its square root) and by
// roughness (rows; from the head's min_roughness to 1), at equal distances, the outer nodes on the border.
// The same for all objects. surface f32 [rows columns, 4]: scale and bias of the split sum, diffuse_view(),
// 0. base, fresnel f32 [rows columns, 4], the two reflection lobes as three round ones
// (core/math/lobe_row.h): share of the normal in the axis, reflection_level() of each, their angle,
// and how steeply the horizon cuts them off: of the cosine of their axis and the normal, times that, the
// logistic function is their share above it.
// lobe f32 [rows, 4]: by how much visibility in bands 1 and 2 is smoothed by a lobe of that roughness, 0, 0.
// Head: columns, rows, min_roughness, middle_share, dielectric_f0, metal_f0.
std::string view_tables();

// "sun": what a round lobe of the light of that sharpness, whose integral over the sphere is 1, adds to both
// maps of view_light(), at equal distances of what they depend on. irradiance f32 [nodes, 1]: by the cosine
// of normal and lobe, from -1 to 1; slightly negative beyond the horizon. reflection f32 [levels nodes, 1]:
// by the square root of half the distance of the two axes on the unit sphere, from 0 to 1. Head: nodes.
std::string view_sun(float sharpness);

}  // namespace cei3d
