// SPDX-License-Identifier: Apache-2.0
// Chooses where rays are sampled: the occupancy grid gives candidates near the surface, their signed
// distances give opacities, and the candidates that carry weight become samples.
#pragma once

#include <span>
#include <vector>

#include "core/math/composite.h"
#include "engine/reconstruct/geometry/geometry_options.h"
#include "engine/reconstruct/geometry/occupancy.h"
#include "engine/reconstruct/geometry/point_values.h"
#include "engine/reconstruct/geometry/ray_batch.h"

namespace cei3d {

// Work memory of one task.
class RaySampler {
 public:
  RaySampler(const FieldConfig& sdf, const SamplingOptions& options);

  // jitter: [0, 1) of each ray, shifts its candidates by so many steps. Where a ray is known to be empty,
  // every candidate inside the surface becomes a sample, however little light reaches it.
  void sample(const GeometryNetworks&, const GeometrySchedule&, const OccupancyGrid&, const RayBatch&,
              std::span<const float> jitter, RaySamples& out);
  int evaluated() const { return evaluated_; }  // candidates of the last batch whose distance was computed

 private:
  struct RayState {
    int first = 0, end = 0;  // its candidates are [first, end)
    int known = 0;           // how many of them, from the front, have a distance
    int passed = 0;          // how many of them, from the front, were composited
    Transmittance<float> light{};
  };
  void march(const GeometrySchedule&, const OccupancyGrid&, const RayBatch&, std::span<const float> jitter);
  void find_distances(const GeometryNetworks&, const RayBatch&);
  bool finished(const GeometrySchedule&, RayState&, bool empty) const;
  float alpha(const GeometrySchedule&, const RayState&, int i) const;
  void select(const GeometrySchedule&, const RayState&, bool empty, std::vector<float>& samples) const;

  SamplingOptions options_;
  PointValues values_;
  int evaluated_ = 0;
  std::vector<RayState> rays_;
  std::vector<int> counts_;                // candidates of each ray
  std::vector<float> depths_, distances_;  // of candidates, ray after ray; not all get a distance
  std::vector<int> active_;                // rays whose next candidates need distances
  std::vector<int> next_;                  // candidates that get a distance next
  std::vector<Vec3f> points_;              // #next_, their points
  std::vector<float> found_;               // #next_, their distances
};

}  // namespace cei3d
