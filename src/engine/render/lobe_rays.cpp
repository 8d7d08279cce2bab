// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lobe_rays.h"

#include <algorithm>
#include <cmath>

#include "core/math/fibonacci.h"
#include "core/math/reflection.h"
#include "core/math/shading.h"
#include "core/math/tangents.h"
#include "engine/render/hit_reflection.h"

namespace cei3d {
namespace {

// In proportion to the roughness of the lobe, more for metals, whose reflections are stronger. A dielectric
// that reflects less than kFaint towards the viewer gets the fewest.
constexpr float kMetalRays = 80, kDielectricRays = 28;  // number of rays per unit of roughness
constexpr int kMaxMetalRays = 24, kMaxDielectricRays = 10;
constexpr float kFaint = 0.02f;

// Radians. Several turns from pixel to pixel, and smooth, so that positions which differ by rounding get
// nearly the same.
float turn_of(Vec3f position) { return dot(position, Vec3f{11003, 13007, 17011}); }

// Normal to the plane of incidence; where the viewer is above and there is none, any normal to the axis.
Vec3f across(const LobeFrame<float>& lobe) {
  if (dot(lobe.across, lobe.across) > 0.25f) return lobe.across;
  return -tangents_of(lobe.axis, 2).x;
}

}  // namespace

int lobe_ray_count(const Material& m, float nv) {
  const bool metal = m.metalness > 0;
  if (!metal) {
    const SplitSum<float> s = split_sum(split_sum_table(), nv, m.roughness);
    const float f0 = dielectric_f0(m.specular, m.metalness), f90 = f90_of(m.specular, m.metalness);
    if (reflectance(s, f0, f90) < kFaint) return kMinLobeRays;
  }
  const float rays = m.roughness * (metal ? kMetalRays : kDielectricRays);
  return std::clamp(int(rays + 0.5f), kMinLobeRays, metal ? kMaxMetalRays : kMaxDielectricRays);
}

// Each at the radius that halves its share of the energy. The lobe 1 / (1 + r^2)^2 has the cumulative share
// r^2 / (1 + r^2), half of it at r = 1.
std::vector<Vec2f> lobe_points(int count) {
  std::vector<Vec2f> points;
  for (int k = 0; k < count; ++k) {
    const float u = (float(k) + 0.5f) / float(count), r = std::sqrt(u / (1 - u)), a = float(kGoldenAngle * k);
    points.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return points;
}

LobeRays::LobeRays(const Hit& h, const Material& m) : normal_(h.normal) {
  const LobeFrame<float> lobe = mean_lobe(reflection_of(h, m));
  const float width = reflection_half_energy(lobe.roughness);
  const float stretch = std::sqrt(lobe.stretch), turn = turn_of(h.position);
  axis_ = lobe.axis;
  const Vec3f along = normalize(cross(across(lobe), axis_));
  const Vec3f longer = along * (width * stretch), shorter = cross(axis_, along) * (width / stretch);
  x_ = longer * std::cos(turn) + shorter * std::sin(turn);
  y_ = shorter * std::cos(turn) - longer * std::sin(turn);
}

Vec3f LobeRays::at(Vec2f point) const {
  Vec3f half = x_ * point.x + y_ * point.y;  // tangent of half the angle: at most 90 degrees from the axis
  half = half / max(1.0f, std::sqrt(dot(half, half)));
  const float s = dot(half, half);
  const Vec3f ray = (axis_ * (1 - s) + half * 2.0f) / (1 + s);
  return ray - normal_ * (2 * min(dot(ray, normal_), 0.0f));
}

}  // namespace cei3d
