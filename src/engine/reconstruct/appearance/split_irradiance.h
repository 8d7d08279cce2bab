// SPDX-License-Identifier: Apache-2.0
// Irradiance of the vertices under the solution of a linear separation, direct and by one bounce.
#pragma once

#include "engine/reconstruct/appearance/split_system.h"

namespace cei3d {

// The cells of a lat-long light as an image of `height` rows, linear RGB.
Image light_image(const std::vector<Vec3f>& light, int height);

// Mean radiance of a lat-long light (EnvUp::z) around each of sky_directions(), after room_from_object has
// rotated the direction to the frame of the light.
SkyRadiance sky_radiance(const Image& light, const Mat3f& room_from_object = Mat3f::identity());

// Irradiance of every vertex, from the light (of `height` rows) and by one bounce: #V. Under a turning light,
// the mean over the bins; turns null: the light is fixed to the object. which: see Transport; metals that are
// not among these reflect nothing.
std::vector<Vec3f> split_irradiance(const Transport&, const SplitUnknowns&, const SplitMaterials&, int height,
                                    const LightTurns* turns, std::span<const uint8_t> which = {});

// The irradiance of samples under a turning light.
class TurningIrradiance {
 public:
  // which: see split_irradiance(); among them the corners of all rows and of their far points.
  TurningIrradiance(const Transport&, const LightTurns&, int light_height,
                    std::span<const uint8_t> which = {});
  struct Turned {
    DiffuseLightGrad grad;          // of the diffuse light of the rows, by the light
    std::vector<Vec3f> irradiance;  // split_irradiance()
  };
  // Sets the diffuse light of the rows: irradiance in their view over the mean of split_irradiance().
  Turned turn(const SplitUnknowns&, const SplitMaterials&, std::vector<SplitRow>& rows) const;

 private:
  Harmonics at(const SplitRow&) const;

  const Transport& transport_;
  const LightTurns& turns_;
  int height_;
  std::span<const uint8_t> which_;
  LightHarmonics harmonics_;
  std::vector<Harmonics> transfer_;    // #V: irradiance from the harmonics of a light
  std::vector<HarmonicMatrix> views_;  // rotation of the light in each view
  std::vector<HarmonicMatrix> bins_;   // rotation of each bin of LightTurns
  HarmonicMatrix mean_{};              // over the bins
};

}  // namespace cei3d
