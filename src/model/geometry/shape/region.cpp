// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/region.h"

#include <algorithm>
#include <limits>

#include "core/base/json.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {

Region::Region(Points points, Projector projector) {
  auto data = std::make_shared<Data>();
  for (const float r : points.reach) data->max_reach = max(data->max_reach, r);
  if (data->max_reach > 0) data->index = PointIndex(points.positions, data->max_reach);
  data->points = std::move(points);
  data->projector = std::move(projector);
  box_ = box_of(*data);
  data_ = std::move(data);
}

Region::Region(ScoredPoints part) {
  auto data = std::make_shared<Data>();
  data->scored = std::move(part);
  data_ = std::move(data);
}

size_t Region::Points::edited_count() const {
  return edited.empty() ? positions.size() : size_t(std::count(edited.begin(), edited.end(), 1));
}

// With all that the edited points reach.
std::optional<AxisBox> Region::box_of(const Data& d) {
  constexpr float kRounding = 1.001f;
  if (d.points.edited_count() == 0) return std::nullopt;
  AxisBox box;
  float max_reach = 0;
  for (size_t i = 0; i < d.points.positions.size(); ++i) {
    if (!d.points.is_edited(i)) continue;
    box.add(d.points.positions[i]);
    max_reach = max(max_reach, d.points.reach[i]);
  }
  const float reach = kRounding * max_reach;
  return AxisBox{box.min - Vec3f{reach, reach, reach}, box.max + Vec3f{reach, reach, reach}};
}

size_t Region::Data::bytes() const {
  // Bytes of a point itself and, in the index, of its copy, ids and buckets.
  constexpr size_t kPoint = 3 * sizeof(Vec3f) + sizeof(float) + 1 + 3 * sizeof(uint32_t);
  return sizeof(Data) + kPoint * points.positions.size() +
         sizeof(float) * (projector.alpha.data.size() + projector.depth.data.size());
}

Region Region::shelved(const std::shared_ptr<Shelf>& shelf, const std::string& name,
                       const std::function<Region()>& read) const {
  Region out = *this;
  if (!box_) return out;
  const std::shared_ptr<const Data> data = data_.share();
  out.data_ = Shelved<Data>(shelf, name, data->bytes(), data, [read] { return read().data_.share(); });
  return out;
}

bool Region::Data::any_is_edited(Vec3f position, Vec3f normal) const {
  return index.any_within(position, max_reach, [&](size_t i) {
    const Vec3f gap = points.positions[i] - position;
    return dot(gap, gap) < square(points.reach[i]) && dot(points.normals[i], normal) > 0 &&
           points.is_edited(i);
  });
}

bool Region::Data::nearest_is_edited(Vec3f position, Vec3f normal) const {
  float nearest = std::numeric_limits<float>::infinity();
  bool edited = false;
  index.any_within(position, max_reach, [&](size_t i) {
    const Vec3f gap = points.positions[i] - position;
    const float distance = dot(gap, gap);
    if (distance < nearest && distance < square(points.reach[i]) && dot(points.normals[i], normal) > 0) {
      nearest = distance;
      edited = points.is_edited(i);
    }
    return false;
  });
  return edited;
}

bool Region::Data::contains(Vec3f position, Vec3f normal) const {
  if (!scored.empty()) return scored.score(position, normal) >= 0.5f;
  if (projector.empty()) return nearest_is_edited(position, normal);
  if (!projector.covers(position, normal)) return false;
  return points.positions.empty() || any_is_edited(position, normal);
}

bool Region::contains(Vec3f position, Vec3f normal) const {
  return (!box_ || box_->contains(position)) && data_->contains(position, normal);
}

float Region::Weights::at(Vec3f position, Vec3f normal) {
  if (region_.box_ && !region_.box_->contains(position)) return 0;
  if (!data_) data_ = region_.data_.use();
  const Data& data = **data_;
  if (!data.contains(position, normal)) return 0;
  const Projector& projector = data.projector;
  if (!projector.soft()) return 1;
  const Vec3d p = projector.camera.project(to_double(position));
  return projector.alpha_at(p.x, p.y);
}

void Region::save(Tensors& tensors, Json& head) const {
  const auto data = data_.use();
  const Points& points = data->points;
  const Projector& projector = data->projector;
  const ScoredPoints& scored = data->scored;
  if (!scored.empty()) return scored.save(tensors, head["scored"]);
  head["points"] = points.positions.size();
  tensors["region/positions"] = tensor_of(points.positions);
  tensors["region/normals"] = tensor_of(points.normals);
  tensors["region/reach"] = {{int64_t(points.reach.size())}, points.reach, {}};
  if (!points.edited.empty()) tensors["region/edited"] = {{int64_t(points.edited.size())}, {}, points.edited};
  if (!projector.empty()) save_projector(projector, tensors, head["projector"], "region/projector/");
}

Region Region::load(const Tensors& tensors, const Json& head, const std::string& what) {
  JsonReader reader(head, what);
  if (reader.has("scored")) {
    Region scored(ScoredPoints::load(tensors, reader.object("scored")));
    reader.finish();
    return scored;
  }
  const auto n = reader.require<int64_t>("points");
  Points points;
  points.positions = vectors_from(tensors, "region/positions", n);
  points.normals = vectors_from(tensors, "region/normals", n);
  points.reach = require_tensor(tensors, "region/reach", {n}).f32;
  if (tensors.contains("region/edited")) points.edited = require_bytes(tensors, "region/edited", {n}).u8;
  const bool has_projector = reader.has("projector");
  reader.finish();
  if (!has_projector) return Region(std::move(points));
  return Region(std::move(points), load_projector(tensors, reader.object("projector"), "region/projector/"));
}

}  // namespace cei3d
