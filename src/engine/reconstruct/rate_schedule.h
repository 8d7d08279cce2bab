// SPDX-License-Identifier: Apache-2.0
// How the rates of a descent change while it goes on. u: position in it, [0, 1).
#pragma once

#include <algorithm>
#include <cmath>

namespace cei3d {

// Factor of rates that are halved after each of `parts` equal parts of a descent.
inline double halved(double u, int parts) { return std::exp2(-std::floor(u * parts)); }

struct RateSchedule {
  double warm_up = 0.05;  // share of the descent at rates that rise: Adam's first steps have full length
  double last = 0.1;      // factor at the end, which is approached exponentially
  int halving_parts = 0;  // if > 0, rates are halved instead, see halved() [paper sec. 5.1]
};

// Factor of the rates of a step. steps: of the whole descent, at most.
inline double rate_at(const RateSchedule& s, double u, int steps) {
  const double rise = s.warm_up > 0 ? std::min(1.0, (u + 1.0 / steps) / s.warm_up) : 1;
  return rise * (s.halving_parts > 0 ? halved(u, s.halving_parts) : std::pow(s.last, u));
}

}  // namespace cei3d
