// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/traced_hits.h"

#include "core/compute/kernels/field_hit.h"
#include "core/compute/planes.h"
#include "model/geometry/shape/sdf_normals.h"
#include "model/geometry/shape/trace_field.h"

namespace cei3d {
namespace {

constexpr float kBehind = 2.5f;  // rays begin so far before the mesh: outside the unit sphere

std::vector<float> padded(std::span<const float> v, int stride) {
  std::vector<float> p(v.begin(), v.end());
  p.resize(size_t(stride), 0.0f);
  return p;
}

}  // namespace

struct TracedHits::Planes {
  int stride;
  std::vector<float> depths, positions, directions, values, gradients, along;
  TracedHitPlanes view() const {
    return {.stride = stride,
            .depths = depths.data(),
            .positions = positions.data(),
            .directions = directions.data(),
            .values = values.data(),
            .gradients = gradients.data(),
            .gradients_along = along.data()};
  }
};

// Depths count from the hits.
TracedHits::Planes TracedHits::planes(const std::vector<float>& values) const {
  const int stride = padded_to_panels(int(hits_.size()));
  std::vector<Vec3f> directions;
  for (const Hit& h : hits_) directions.push_back(-h.to_camera);
  return {.stride = stride,
          .depths = std::vector<float>(size_t(stride), 0.0f),
          .positions = planes_of(positions_of(hits_), stride),
          .directions = planes_of(directions, stride),
          .values = padded(values, stride),
          .gradients = planes_of(gradients_, stride),
          .along = planes_of(gradients_along_, stride)};
}

TracedHits::TracedHits(const Device& device, const Field& sdf, std::span<const Hit> near, bool are_near)
    : config_(sdf.config()) {
  std::vector<Ray> rays;
  for (const Hit& h : near) rays.push_back({h.position + h.to_camera * kBehind, -h.to_camera});
  const std::vector<float> starts(are_near ? rays.size() : 0, kBehind);
  const std::vector<FieldTrace> found = trace_field(device, sdf, rays, starts);
  std::vector<Vec3f> directions;
  std::vector<float> values;
  for (size_t i = 0; i < near.size(); ++i) {
    if (!found[i].hit) {
      missed_.push_back(rays[i]);
      continue;
    }
    Hit h = near[i];
    h.position += rays[i].direction * (found[i].depth - kBehind);
    hits_.push_back(h);
    rays_.push_back(uint32_t(i));
    directions.push_back(rays[i].direction);
    values.push_back(found[i].value);
  }
  edges_.resize(hits_.size());
  const std::vector<Vec3f> x = positions_of(hits_);
  gradients_ = sdf_gradients(device, sdf, x, edges_);
  gradients_along_ = sdf_gradients_along(device, sdf, x, directions, edges_);
  refine(device, values);
}

// Positions and normals.
void TracedHits::refine(const Device& device, const std::vector<float>& values) {
  if (hits_.empty()) return;
  const Planes in = planes(values);
  std::vector<float> depths(size_t(in.stride)), positions(size_t(3) * in.stride), normals(positions.size());
  device.launch<FieldHits>(
      {.hits = in.view(), .depths = depths.data(), .positions = positions.data(), .normals = normals.data()},
      in.stride);
  for (size_t i = 0; i < hits_.size(); ++i) {
    hits_[i].position = load_planes<float>(positions.data(), in.stride, int(i));
    hits_[i].normal = load_planes<float>(normals.data(), in.stride, int(i));
  }
}

std::vector<Vec3f> TracedHits::moved(float along) const {
  std::vector<Vec3f> out;
  for (const Hit& h : hits_) out.push_back(h.position - h.to_camera * along);
  return out;
}

void TracedHits::backward(const Device& device, std::span<const float> d_depths,
                          std::span<const Vec3f> d_normals, ValueGrads& out) const {
  if (hits_.empty()) return;
  const Planes in = planes(std::vector<float>(hits_.size(), 0.0f));
  const std::vector<float> depths = padded(d_depths, in.stride), normals = planes_of(d_normals, in.stride),
                           positions(size_t(3) * in.stride, 0.0f);
  std::vector<float> d_values(size_t(in.stride)), d_planes(size_t(3) * in.stride);
  device.launch<FieldHitsGrad>({.hits = in.view(),
                                .d_depths = depths.data(),
                                .d_positions = positions.data(),
                                .d_normals = normals.data(),
                                .d_values = d_values.data(),
                                .d_gradients = d_planes.data()},
                               in.stride);
  std::vector<Vec3f> d_gradients;
  for (size_t i = 0; i < hits_.size(); ++i) {
    out.points.push_back(hits_[i].position);
    out.d_values.push_back(d_values[i]);
    d_gradients.push_back(load_planes<float>(d_planes.data(), in.stride, int(i)));
  }
  add_value_grads(config_, positions_of(hits_), d_gradients, edges_, out.points, out.d_values);
}

}  // namespace cei3d
