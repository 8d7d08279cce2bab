// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/spread.h"

#include "model/geometry/point_index.h"

namespace cei3d {
namespace {

constexpr float kUnknown = 0.5f;
constexpr float kReach = 2.5f;  // spacings

// Mean score of the known neighbours, kUnknown where there are none (or they balance exactly).
float known_around(const HandlerPoints& points, const PointIndex& index, const std::vector<float>& scores,
                   size_t i) {
  float sum = 0;
  int count = 0;
  index.any_within(points.positions[i], kReach * points.spacing, [&](size_t k) {
    if (scores[k] == kUnknown || dot(points.normals[k], points.normals[i]) <= 0) return false;
    sum += scores[k];
    ++count;
    return false;
  });
  return count ? sum / float(count) : kUnknown;
}

}  // namespace

void spread_scores(const HandlerPoints& points, std::vector<float>& scores) {
  const PointIndex index(points.positions, kReach * points.spacing);
  std::vector<size_t> unknown;
  for (size_t i = 0; i < scores.size(); ++i)
    if (scores[i] == kUnknown) unknown.push_back(i);
  while (!unknown.empty()) {
    std::vector<float> found;
    for (size_t i : unknown) found.push_back(known_around(points, index, scores, i));
    std::vector<size_t> left;
    for (size_t k = 0; k < unknown.size(); ++k) {
      scores[unknown[k]] = found[k];
      if (found[k] == kUnknown) left.push_back(unknown[k]);
    }
    if (left.size() == unknown.size()) break;
    unknown.swap(left);
  }
  for (size_t i : unknown) scores[i] = 0;
}

}  // namespace cei3d
