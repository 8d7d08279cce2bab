// SPDX-License-Identifier: Apache-2.0
// For tests of the joint descent: a colored ball, and pictures of it that its own shading model has drawn, so
// that a descent can reach it.
#pragma once

#include "core/math/color.h"
#include "core/math/fibonacci.h"
#include "engine/reconstruct/joint/joint_descent.h"
#include "engine/reconstruct/surface_and_hits.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {

struct BallViews {
  int count = 12, size = 48;
  Camera camera(int view) const {
    return camera_towards_origin(to_double(fibonacci_direction(view, count)) * 3.0, size);
  }
};

// Blobs of color: a coarse hash grid of random entries.
inline Field blobs() {
  FieldConfig c;
  c.encoding = {0, 3, 6, 20, 12};
  c.width = 16;
  c.output_activation = Activation::sigmoid;
  Field field(c, 3);
  for (int level = 0; level < 3; ++level)
    for (float& v : field.params().all()[size_t(level)].value) v *= 2e4f;
  return field;
}

inline SgMixture studio() {
  return {{{normalize(Vec3f{1, 0.4f, 1}), 25, {2.5f, 2, 1.5f}},
           {normalize(Vec3f{-1, 1, 0.3f}), 12, {0.6f, 1.0f, 1.6f}},
           {normalize(Vec3f{0.2f, -1, -0.5f}), 20, {1, 1.6f, 1}},
           {{0, 0, 1}, 1.2f, {0.35f, 0.35f, 0.35f}},
           {{0, 0, -1}, 1.2f, {0.25f, 0.25f, 0.25f}}}};
}

// Pictures of an object whose surface is `surface`: one ray per pixel.
inline PixelStore pictures_of(const Device& device, const JointObject& object,
                              const std::shared_ptr<const Surface>& surface, const BallViews& views) {
  const std::vector<Vec3f>& vertices = surface->mesh().positions;
  const Transport transport(surface);
  Lighting lighting(
      device, surface, object.light,
      vertex_light(transport, object.light,
                   {object.albedo.eval3(device, vertices), object.material.at(device, vertices)}));
  lighting.use_hit_normals();
  PixelStore store;
  for (int view = 0; view < views.count; ++view) {
    const Camera camera = views.camera(view);
    std::vector<Ray> rays;
    for (int i = 0; i < views.size * views.size; ++i)
      rays.push_back(camera.ray(i % views.size + 0.5, double(i / views.size) + 0.5));
    std::vector<uint32_t> ray_of_hit;
    const std::vector<Hit> hits = trace_rays(device, object.sdf, *surface, rays, ray_of_hit);
    const std::vector<Vec3f> x = positions_of(hits);
    const std::vector<Material> materials = object.material.at(device, x);
    const Shading shading = lighting.shade({hits, materials}, object.albedo.eval3(device, x));
    Image image(views.size, views.size, 4);
    for (size_t k = 0; k < hits.size(); ++k) {
      float* p = image.at(int(ray_of_hit[k]) % views.size, int(ray_of_hit[k]) / views.size);
      for (int c = 0; c < 3; ++c) p[c] = (shading.diffuse[k] + shading.specular[k])[c];
      p[3] = 1;
    }
    store.add_view(camera, image, 4);
  }
  return store;
}

// Hits at pixel centers: the pictures show points.
inline SurfaceSamples point_samples(const ObjectHits& hits) { return {hits.hits, hits.colors, hits.clipped}; }

}  // namespace cei3d
