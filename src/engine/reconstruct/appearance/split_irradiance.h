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

// What matte surfaces see of a light that turns.
class TurningIrradiance {
 public:
  TurningIrradiance(const Transport&, const LightTurns&, int light_height);
  // Sets the diffuse light of the rows: the irradiance in their view over the mean that split_irradiance()
  // gives. Returns how it follows the light.
  DiffuseSlopes turn(const SplitUnknowns&, const SplitMaterials&, std::vector<SplitRow>& rows) const;

 private:
  Harmonics at(const SplitRow&) const;

  const Transport& transport_;
  const LightTurns& turns_;
  int height_;
  LightHarmonics harmonics_;
  std::vector<Harmonics> transfer_;    // #V: irradiance from the harmonics of a light
  std::vector<HarmonicMatrix> views_;  // of each view's rotation
  std::vector<HarmonicMatrix> bins_;
  HarmonicMatrix mean_{};  // over the bins
};

}  // namespace cei3d
