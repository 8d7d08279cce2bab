// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/region.h"

#include <algorithm>

#include "core/base/error.h"

namespace cei3d {
namespace {

Tensor tensor_of(const std::vector<Vec3f>& v) {
  Tensor t{{int64_t(v.size()), 3}, {}, {}};
  t.f32.reserve(3 * v.size());
  for (const Vec3f p : v) t.f32.insert(t.f32.end(), {p.x, p.y, p.z});
  return t;
}

const Tensor& find(const Tensors& tensors, const std::string& name, size_t floats) {
  const auto it = tensors.find(name);
  if (it == tensors.end())
    fail("the edit's data lack '{}'; the project is damaged, undo or repeat the edit", name);
  if (it->second.f32.size() != floats)
    fail("'{}' holds {} numbers where {} belong; the project is damaged, undo or repeat the edit", name,
         it->second.f32.size(), floats);
  return it->second;
}

std::vector<Vec3f> vectors_of(const Tensor& t) {
  std::vector<Vec3f> v(t.f32.size() / 3);
  for (size_t i = 0; i < v.size(); ++i) v[i] = {t.f32[3 * i], t.f32[3 * i + 1], t.f32[3 * i + 2]};
  return v;
}

}  // namespace

Region::Region(Points points, Projector projector)
    : points_(std::move(points)), projector_(std::move(projector)) {
  for (const float r : points_.reach) max_reach_ = max(max_reach_, r);
  if (max_reach_ > 0) index_ = PointIndex(points_.positions, max_reach_);
}

Region::Region(ScoredPoints part) : scored_(std::move(part)) {}

bool Region::contains(Vec3f position, Vec3f normal) const {
  if (!scored_.empty()) return scored_.score(position, normal) >= 0.5f;
  if (!projector_.empty() && !projector_.covers(position, normal)) return false;
  if (!projector_.empty() && points_.positions.empty()) return true;
  return index_.any_within(position, max_reach_, [&](size_t i) {
    const Vec3f d = points_.positions[i] - position;
    return dot(d, d) < square(points_.reach[i]) && dot(points_.normals[i], normal) > 0;
  });
}

float Region::weight(Vec3f position, Vec3f normal) const {
  if (!contains(position, normal)) return 0;
  if (!projector_.soft()) return 1;
  const Vec3d p = projector_.camera.project(to_double(position));
  return projector_.alpha_at(p.x, p.y);
}

void Region::save(Tensors& tensors, Json& head) const {
  if (!scored_.empty()) return scored_.save(tensors, head["scored"]);
  head["points"] = points_.positions.size();
  tensors["region/positions"] = tensor_of(points_.positions);
  tensors["region/normals"] = tensor_of(points_.normals);
  tensors["region/reach"] = {{int64_t(points_.reach.size())}, points_.reach, {}};
  if (!projector_.empty()) save_projector(projector_, tensors, head["projector"], "region/projector/");
}

Region Region::load(const Tensors& tensors, const Json& head) {
  if (head.contains("scored")) return Region(ScoredPoints::load(tensors, head.at("scored")));
  const size_t n = head.at("points").get<size_t>();
  Points points;
  points.positions = vectors_of(find(tensors, "region/positions", 3 * n));
  points.normals = vectors_of(find(tensors, "region/normals", 3 * n));
  points.reach = find(tensors, "region/reach", n).f32;
  if (!head.contains("projector")) return Region(std::move(points));
  return Region(std::move(points), load_projector(tensors, head["projector"], "region/projector/"));
}

}  // namespace cei3d
