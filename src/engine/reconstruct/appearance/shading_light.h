// SPDX-License-Identifier: Apache-2.0
// Light of a surface whose reflections say nothing about it, from its shading: places that are near each
// other and of one hue have mostly one albedo, so that what differs between them is their irradiance.
// (docs/method.md#light-from-shading)
#pragma once

#include <span>
#include <vector>

#include "engine/render/transport.h"

namespace cei3d {

struct ShadingLight {
  SkyRadiance sky;                // white, > 0
  std::vector<Vec3f> irradiance;  // #V, with the bounce
};

// Albedo of the brightest places, which decides the strength of the light.
inline constexpr float kBrightAlbedo = 0.8f;

// A white light with its bounce. diffuse: #V, diffuse radiance, linear; black vertices take no part.
ShadingLight light_of_shading(const Transport&, std::span<const Vec3f> diffuse, uint64_t seed);

// Radiance of the cells of a lat-long grid (EnvUp::z) of `height` rows: the mean of the nearest directions.
std::vector<Vec3f> grid_of_sky(const SkyRadiance&, int height);

}  // namespace cei3d
