// SPDX-License-Identifier: Apache-2.0
// The light that the solution of a split sends to the vertices, directly and by one bounce.
#pragma once

#include "engine/reconstruct/appearance/split_system.h"

namespace cei3d {

Image light_image(const std::vector<Vec3f>& light, int height);

// Mean of a lat-long light (EnvUp::z) around each of sky_directions(), which a rotation takes to its frame.
SkyRadiance sky_radiance(const Image& light, const Mat3f& room_from_object = Mat3f::identity());

// Irradiance of every vertex, from the light and from the surface. light: of `height` rows. turns: null: the
// light stands still; else the mean over the bins.
std::vector<Vec3f> split_irradiance(const Transport&, const SplitUnknowns&, const SplitMaterials&, int height,
                                    const LightTurns* turns);

// Moves the diffuse light of the rows by a share of the way to the irradiance of their bin over the mean that
// split_irradiance() gives.
void turn_diffuse_light(const Transport&, const SplitUnknowns&, const SplitMaterials&, int height,
                        const LightTurns& turns, float share, std::vector<SplitRow>& rows);

}  // namespace cei3d
