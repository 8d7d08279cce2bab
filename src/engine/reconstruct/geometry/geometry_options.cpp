// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/geometry_options.h"

#include <algorithm>
#include <cmath>

#include "engine/reconstruct/rate_schedule.h"

namespace cei3d {

int levels_at(const GeometryOptions& o, double u) {
  const int all = o.sdf.encoding.levels, first = std::min(o.first_levels, all);
  return std::min(all, first + int((all - first + 1) * u / o.unlock_until));
}

GeometrySchedule schedule_at(const GeometryOptions& o, double u) {
  const double p = std::min(1.0, u / o.inv_s_until);
  GeometrySchedule s;
  s.inv_s = float(o.inv_s_start * std::pow(double(o.inv_s_end) / o.inv_s_start, p));
  s.step = std::clamp(o.sampling.step_width / s.inv_s, o.sampling.step_min, o.sampling.step_max);
  s.band = std::max(4 / s.inv_s, 1.5f * s.step);
  // Early, the surface moves and bends between two updates of the grid: as little slack from the beginning
  // costs half a decibel on thin rods (docs/notebook/0013).
  s.slack = u >= o.tight_grid_from ? 0.25f : 1;
  s.view_dependent = true;
  s.anchor = o.loss.anchor * s.inv_s * float(std::max(0.0, 1 - u / o.anchor_until));
  return s;
}

float rate_at(const GeometryOptions& o, double u) {
  const double warm_up = std::min(1.0, u / 0.02 + 0.01);
  if (o.halving_parts > 0) return float(warm_up * halved(u, o.halving_parts));
  const double decay =
      u < o.decay_from ? 1.0 : std::pow(double(o.decay_to), (u - o.decay_from) / (1 - o.decay_from));
  return float(warm_up * decay);
}

}  // namespace cei3d
