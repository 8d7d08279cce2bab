// SPDX-License-Identifier: Apache-2.0
// The surface for rays and light: a mesh of the zero level set, a ray index (BVH), and a visibility table:
// for every vertex, which sky directions are not occluded.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "model/geometry/mesh/mesh.h"
#include "model/geometry/shape/hit.h"
#include "model/geometry/shape/sky.h"

namespace cei3d {

class Surface {
 public:
  // Casts the visibility rays: seconds, minutes on one core. Error: interrupted.
  explicit Surface(Mesh mesh, const Progress& progress = Progress());
  Surface(Mesh mesh, std::vector<uint8_t> visibility);  // from a stored table
  // A surface after an edit. recast: #V, 1: recompute the visibility of the vertex; 0: take it from `before`.
  Surface(Mesh mesh, const Surface& before, std::span<const uint8_t> recast);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  const Mesh& mesh() const { return mesh_; }
  // #V x kSkyDirections / 8 bytes; bit 1: not occluded.
  const std::vector<uint8_t>& visibility() const { return visibility_; }
  bool sees(uint32_t vertex, int direction) const {
    return visibility_[size_t(vertex) * (kSkyDirections / 8) + direction / 8] >> (direction % 8) & 1;
  }
  // Whether the sky is visible from the triangle in a unit direction according to the table: its three
  // corners see it in all directions of sky_around().
  bool sees_around(uint32_t triangle, Vec3f direction) const;

  struct RayHit {
    float t = -1;  // negative: nothing hit
    uint32_t triangle = 0;
    float b1 = 0, b2 = 0;
  };
  // Closest hits with t in (t_min, inf). origins, directions, out: #N. Runs on all threads.
  void intersect(std::span<const Vec3f> origins, std::span<const Vec3f> directions, float t_min,
                 std::span<RayHit> out) const;

 private:
  struct Bvh;
  Mesh mesh_;
  std::vector<uint8_t> visibility_;
  std::unique_ptr<Bvh> bvh_;
};

}  // namespace cei3d
