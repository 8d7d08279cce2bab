// SPDX-License-Identifier: Apache-2.0
// The surface as rays and light see it: a mesh of the zero level set, an index for rays, and for every vertex
// which directions of the sky are free.
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
  // A changed one. looks: #V, 1 where the vertex looks at the sky again, 0 where it keeps what it saw before.
  Surface(Mesh mesh, const Surface& before, std::span<const uint8_t> looks);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  const Mesh& mesh() const { return mesh_; }
  const std::vector<uint8_t>& visibility() const {
    return visibility_;
  }  // #V x kSkyDirections / 8, bit = free
  bool sees(uint32_t vertex, int direction) const {
    return visibility_[size_t(vertex) * (kSkyDirections / 8) + direction / 8] >> (direction % 8) & 1;
  }
  // Nothing is in the way from this triangle along a direction (unit), as far as the table knows: its three
  // corners see the sky in all of sky_around().
  bool open(uint32_t triangle, Vec3f direction) const;

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
