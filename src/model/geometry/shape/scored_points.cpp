// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/scored_points.h"

#include "core/base/error.h"
#include "core/base/json.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {
namespace {

constexpr float kReach = 2.5f;  // spacings
constexpr float kInside = 0.5f;

// Indices of the points that can affect scores of at least one half: those within two reaches of a point with
// such a score.
std::vector<uint8_t> near_part(const ScoredPoints::Data& d) {
  const float radius = 2 * kReach * d.spacing;
  const PointIndex index(d.positions, radius);
  std::vector<uint8_t> near(d.positions.size(), 0);
  for (size_t i = 0; i < d.positions.size(); ++i) {
    if (d.scores[i] < kInside) continue;
    index.any_within(d.positions[i], radius, [&](size_t k) {
      near[k] = 1;
      return false;
    });
  }
  return near;
}

}  // namespace

ScoredPoints::ScoredPoints(const Data& all) {
  if (all.positions.empty() || !(all.spacing > 0)) return;
  const std::vector<uint8_t> near = near_part(all);
  data_.spacing = all.spacing;
  for (size_t i = 0; i < near.size(); ++i) {
    if (!near[i]) continue;
    data_.positions.push_back(all.positions[i]);
    data_.normals.push_back(all.normals[i]);
    data_.scores.push_back(all.scores[i]);
  }
  if (!empty()) index_ = PointIndex(data_.positions, radius());
}

float ScoredPoints::radius() const { return kReach * data_.spacing; }

float ScoredPoints::score(Vec3f position, Vec3f normal) const {
  if (empty()) return 0;
  const float scale = 1 / square(radius());
  float sum = 0, weight = 0;
  index_.any_within(position, radius(), [&](size_t i) {
    if (dot(data_.normals[i], normal) <= 0) return false;
    const Vec3f d = data_.positions[i] - position;
    const float t = 1 - dot(d, d) * scale, w = t * t * t;  // a Gaussian of one spacing, but for its tail
    sum += w * data_.scores[i];
    weight += w;
    return false;
  });
  return weight > 0 ? sum / weight : 0;
}

void ScoredPoints::save(Tensors& tensors, Json& head) const {
  const int64_t n = int64_t(data_.positions.size());
  head["points"] = n;
  head["spacing"] = data_.spacing;
  tensors["region/scored/positions"] = tensor_of(data_.positions);
  tensors["region/scored/normals"] = tensor_of(data_.normals);
  tensors["region/scored/scores"] = {{n, 1}, data_.scores, {}};
}

ScoredPoints ScoredPoints::load(const Tensors& tensors, JsonReader head) {
  const int64_t n = rows_from(head.member("points"));
  ScoredPoints s;
  s.data_.spacing = head.require<float>("spacing");
  head.finish();
  s.data_.positions = vectors_from(tensors, "region/scored/positions", n);
  s.data_.normals = vectors_from(tensors, "region/scored/normals", n);
  s.data_.scores = require_tensor(tensors, "region/scored/scores", {n, 1}).f32;
  if (n > 0 && !(s.data_.spacing > 0))
    fail("The edit's points have no spacing. The project is damaged: undo or repeat the edit.");
  if (n > 0) s.index_ = PointIndex(s.data_.positions, s.radius());
  return s;
}

}  // namespace cei3d
