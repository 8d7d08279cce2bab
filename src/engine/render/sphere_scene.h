// SPDX-License-Identifier: Apache-2.0
// For tests: the smallest whole object, a sphere.
#pragma once

#include <algorithm>

#include "model/scene/scene.h"

namespace cei3d {

inline constexpr float kSphereRadius = 0.7f;

// A sphere of triangles between meridians and circles of latitude.
inline Mesh sphere_mesh(int rows, int columns) {
  Mesh m;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const float theta = kPi * float(i) / float(rows), phi = 2 * kPi * float(j) / float(columns);
      const Vec3f n{sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
      m.normals.push_back(n);
      m.positions.push_back(n * kSphereRadius);
    }
  }
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const uint32_t a = uint32_t(i * columns + j), b = uint32_t(i * columns + (j + 1) % columns);
      m.triangles.push_back({a, a + uint32_t(columns), b});
      m.triangles.push_back({b, a + uint32_t(columns), b + uint32_t(columns)});
    }
  }
  return m;
}

// The field is exactly the sphere; the albedo is noise, the light has a broad and a narrow lobe.
inline Scene sphere_scene() {
  Scene s;
  FieldConfig sdf;
  sdf.outputs = 1;
  sdf.activation = Activation::softplus;
  sdf.sphere_radius = kSphereRadius;
  auto sdf_field = std::make_shared<Field>(sdf, 1);
  for (Param& p : sdf_field->params().all())
    std::fill(p.value.begin(), p.value.end(), 0.0f);  // exactly the sphere
  s.sdf = sdf_field;
  FieldConfig albedo;
  albedo.encoding.levels = 4;
  albedo.output_activation = Activation::sigmoid;
  s.albedo = std::make_shared<Field>(albedo, 2);
  Mesh mesh = sphere_mesh(64, 128);
  std::vector<uint8_t> visibility(mesh.positions.size() * (kSkyDirections / 8), 0xff);
  s.surface = std::make_shared<Surface>(std::move(mesh), std::move(visibility));
  s.light.lobes = {{{0, 0, 1}, 2, {1, 1, 1}}, {{1, 0, 0}, 20, {2, 1, 1}}};
  return s;
}

// sphere_scene() with a handler point at each vertex.
inline Scene sphere_with_handlers() {
  Scene s = sphere_scene();
  auto points = std::make_shared<HandlerPoints>();
  points->positions = s.surface->mesh().positions;
  points->normals = s.surface->mesh().normals;
  points->footprints.assign(points->positions.size(), 0.02f);
  points->spacing = 0.02f;
  s.handlers = points;
  return s;
}

// Upright, of size x size pixels most of which the sphere fills.
inline Camera camera_towards_origin(Vec3d center, int size) {
  Camera c;
  c.width = c.height = size;
  c.fx = c.fy = 150.0 / 96 * size;
  c.cx = c.cy = size / 2.0;
  c.center = center;
  c.world_from_cam = upright_rotation(-center, {0, 0, 1});
  return c;
}

}  // namespace cei3d
