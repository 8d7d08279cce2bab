// SPDX-License-Identifier: Apache-2.0
// For tests: a ball under a free sky, in a capture whose frame is not the unit sphere's.
#pragma once

#include "model/geometry/mesh/test_meshes.h"
#include "model/scene/scene.h"

namespace cei3d {

constexpr float kBallRadius = 0.5f;

// subdivisions: of its mesh. colors: the encoding of its albedo field, which is not trained.
inline Scene test_ball(int subdivisions, const EncodingConfig& colors) {
  Scene s;
  s.normalization = {{1, 2, 3}, 2};
  Mesh mesh = sphere_mesh(kBallRadius, subdivisions);
  std::vector<uint8_t> free_sky(mesh.positions.size() * kSkyDirections / 8, 0xff);
  s.surface = std::make_shared<const Surface>(std::move(mesh), std::move(free_sky));
  FieldConfig albedo;
  albedo.encoding = colors;
  albedo.output_activation = Activation::sigmoid;
  s.albedo = std::make_shared<Field>(albedo, 3);
  s.material = Material{.roughness = 0.4f};
  return s;
}

}  // namespace cei3d
