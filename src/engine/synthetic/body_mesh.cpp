// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/body_mesh.h"

#include "core/base/parallel.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {

Mesh body_mesh(const Body& body, int resolution) {
  Mesh mesh = surface_net(
      [&](std::span<const Vec3f> points) {
        std::vector<float> d(points.size());
        parallel_ranges(int(points.size()), 4096, [&](int begin, int end) {
          for (int i = begin; i < end; ++i) d[size_t(i)] = body.distance(points[size_t(i)]);
        });
        return d;
      },
      resolution);
  mesh.normals.resize(mesh.positions.size());
  parallel_ranges(int(mesh.positions.size()), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Vec3f& p = mesh.positions[size_t(i)];
      for (int step = 0; step < 3; ++step) p = p - body.normal(p) * body.distance(p);
      mesh.normals[size_t(i)] = body.normal(p);
    }
  });
  return mesh;
}

}  // namespace cei3d
