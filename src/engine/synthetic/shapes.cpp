// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/shapes.h"

#include <cmath>

#include "core/base/error.h"
#include "engine/synthetic/names.h"
#include "engine/synthetic/teapot.h"

namespace cei3d {
namespace {

constexpr size_t kBody = 0, kBand = 1, kLid = 2, kTrim = 3;

// Within a belt around the z axis whose borders go up and down nine times.
bool in_wavy_belt(Vec3f p, float height, float half_width, float wave) {
  return std::abs(p.z - height - wave * std::sin(9 * std::atan2(p.y, p.x))) < half_width;
}

size_t ball_region(Vec3f p) {
  if (p.z > 0.5f * length(p)) return kLid;
  return in_wavy_belt(p, 0, 0.12f, 0.04f) ? kBand : kBody;
}

size_t box_region(Vec3f p) {
  if (p.z > 0.3f) return kLid;
  return in_wavy_belt(p, -0.05f, 0.1f, 0.03f) ? kBand : kBody;
}

size_t teapot_region(Vec3f p) {
  const float belly = TeapotDistance::belly(p), lid = TeapotDistance::lid(p);
  if (lid < belly && TeapotDistance::from_axis(p) < 0.3f) return p.z > 0.46f ? kTrim : kLid;
  if (min(TeapotDistance::handle(p), TeapotDistance::spout(p)) < belly) return kTrim;
  return in_wavy_belt(p, -0.08f, 0.06f, 0.04f) ? kBand : kBody;
}

template <class Distance>
Shape shape_of(const char* name, Distance distance, std::vector<std::string> regions,
               size_t (*region_at)(Vec3f)) {
  return {name, std::make_shared<SdfBody<Distance>>(distance), std::move(regions), region_at};
}

}  // namespace

Shape ball_shape(float radius) {
  return shape_of("ball", BallDistance{radius}, {"body", "band", "lid"}, ball_region);
}
Shape box_shape() { return shape_of("box", BoxDistance{}, {"body", "band", "lid"}, box_region); }
Shape teapot_shape() {
  return shape_of("teapot", TeapotDistance{}, {"body", "band", "lid", "trim"}, teapot_region);
}

std::vector<std::string> shape_names() { return {"ball", "box", "teapot"}; }

Shape shape_by_name(const std::string& name) {
  for (Shape shape : {ball_shape(), box_shape(), teapot_shape()})
    if (shape.name == name) return shape;
  fail_usage("There is no shape '{}'; there are {}.", name, listed(shape_names()));
}

}  // namespace cei3d
