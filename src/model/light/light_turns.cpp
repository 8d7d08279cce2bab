// SPDX-License-Identifier: Apache-2.0
#include "model/light/light_turns.h"

#include <algorithm>
#include <array>

#include "core/math/rotation.h"

namespace cei3d {
namespace {

constexpr std::array<const char*, 3> kNames = {"world", "camera", "turntable"};
constexpr float kFineEnough = 0.06f;  // radians between a rotation and its bin

float angle_between(const Mat3f& a, const Mat3f& b) {
  float trace = 0;
  for (int i = 0; i < 3; ++i) trace += dot(a.row[i], b.row[i]);
  return std::acos(clamp((trace - 1) / 2, -1.0f, 1.0f));
}

// Right, down and forward, in the frame of the object.
Mat3f axes_of(const Mat3f& world_from_cam) { return transpose(world_from_cam); }

}  // namespace

const char* light_motion_name(LightMotion motion) { return kNames[size_t(motion)]; }

std::optional<LightMotion> light_motion_named(const std::string& name) {
  const auto at = std::find(kNames.begin(), kNames.end(), name);
  if (at == kNames.end()) return {};
  return LightMotion(at - kNames.begin());
}

float CameraRing::tilt(const Mat3f& world_from_cam) const {
  const Mat3f seen = axes_of(world_from_cam);
  const auto angle = [](float cosine) { return std::asin(clamp(cosine, -1.0f, 1.0f)); };
  return std::hypot(angle(dot(seen.row[2], axis)) - angle(forward),
                    angle(dot(seen.row[0], axis)) - angle(right));
}

// To axes that stand still while the object turns: towards the camera, aside, and up.
Mat3f LightFrame::table_from_object(const Mat3f& world_from_cam) const {
  const Vec3f up =
      std::min_element(rings.begin(), rings.end(), [&](const CameraRing& a, const CameraRing& b) {
        return a.tilt(world_from_cam) < b.tilt(world_from_cam);
      })->axis;
  const Vec3f back = -axes_of(world_from_cam).row[2], towards = normalize(back - up * dot(back, up));
  return {{towards, cross(up, towards), up}};
}

Mat3f LightFrame::room_from_object(const Mat3d& world_from_cam) const {
  const Mat3f camera = to_float(world_from_cam);
  if (motion == LightMotion::camera) return reference * transpose(camera);
  if (motion == LightMotion::turntable && !rings.empty())
    return transpose(table_from_object(reference)) * table_from_object(camera);
  if (motion == LightMotion::turntable)
    return about_axis(axis, -angle_about(axis, camera * transpose(reference)));
  return Mat3f::identity();
}

// Each bin is the rotation that is farthest from the bins before it.
LightTurns light_turns(std::vector<Mat3f> rotations) {
  LightTurns out;
  out.bin.assign(rotations.size(), 0);
  std::vector<float> distance(rotations.size(), 10);
  while (out.bins.size() < kMaxLightBins) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (farthest == distance.end() || *farthest < kFineEnough) break;
    const Mat3f bin = rotations[size_t(farthest - distance.begin())];
    for (size_t i = 0; i < rotations.size(); ++i) {
      const float d = angle_between(rotations[i], bin);
      if (d >= distance[i]) continue;
      distance[i] = d;
      out.bin[i] = uint8_t(out.bins.size());
    }
    out.bins.push_back(bin);
  }
  out.room_from_object = std::move(rotations);
  return out;
}

std::vector<uint16_t> views_of(const TurnedHits& hits, std::span<const uint32_t> points) {
  std::vector<uint16_t> out;
  for (size_t k = 0; hits.turns && k < points.size(); ++k) out.push_back(hits.views[points[k]]);
  return out;
}

}  // namespace cei3d
