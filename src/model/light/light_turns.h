// SPDX-License-Identifier: Apache-2.0
// Light that turns against the object from view to view: on a turntable the object turns under lamps
// that stand still, which in the object's frame is a light that goes round with the camera.
// (docs/method.md#turning-light)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

enum class LightMotion {
  world,     // stands still against the object
  camera,    // is fixed to the camera: a flash, or a turntable before a camera that never moved
  turntable  // goes round an axis, or the axes of several rings, with the camera's azimuth
};
const char* light_motion_name(LightMotion);
std::optional<LightMotion> light_motion_named(const std::string&);

// Photographs between which only the object turned, about one axis, before a camera that stood still.
struct CameraRing {
  Vec3f axis{0, 0, 1};           // unit, capture frame; points up in the photographs
  float forward = 0, right = 0;  // cosines between the axis and the camera's view direction, and its right

  // How far, in radians, a camera is tilted against that of the ring.
  float tilt(const Mat3f& world_from_cam) const;
};

// The frame of the light, "room" in names, in which a turning light stands still: that of the object in one
// of its photographs.
struct LightFrame {
  LightMotion motion = LightMotion::world;
  Vec3f axis{0, 0, 1};                  // of the turntable; unit, capture frame
  Mat3f reference = Mat3f::identity();  // rotation of that photograph's camera, world_from_cam
  // Of a turntable on which the object lay in several ways, or before which the camera was moved up or down;
  // a camera is of the ring with the smallest tilt. Empty: all views are about the axis.
  std::vector<CameraRing> rings = {};

  // The rotation of the light in the view of a camera with this rotation: it takes a direction of the object
  // to the direction in the reference photograph from which the same light comes.
  Mat3f room_from_object(const Mat3d& world_from_cam) const;

 private:
  Mat3f table_from_object(const Mat3f& world_from_cam) const;
};

// The rotations of a turning light in the views of a capture.
struct LightTurns {
  std::vector<Mat3f> room_from_object;  // #views
  std::vector<uint8_t> bin;             // #views, index of the nearest of `bins`
  // A few rotations that stand for all of them where light arrives blurred, as on matte surfaces.
  std::vector<Mat3f> bins;
};
constexpr size_t kMaxLightBins = 16;
LightTurns light_turns(std::vector<Mat3f> room_from_object);

// Which view shows each of some points of a surface, and thereby how the light is turned there.
struct TurnedHits {
  const LightTurns* turns = nullptr;     // null: the light stands still
  std::span<const uint16_t> views = {};  // #points

  size_t bins() const { return turns ? turns->bins.size() : 1; }
  size_t bin(size_t i) const { return turns ? turns->bin[views[i]] : 0; }
  Vec3f in_room(size_t i, Vec3f d) const { return turns ? turns->room_from_object[views[i]] * d : d; }
  Vec3f in_object(size_t i, Vec3f d) const {
    return turns ? transpose(turns->room_from_object[views[i]]) * d : d;
  }
  TurnedHits part(size_t begin, size_t count) const {
    return turns ? TurnedHits{turns, views.subspan(begin, count)} : TurnedHits{};
  }
};

// The views of some of the points; nothing where the light stands still.
std::vector<uint16_t> views_of(const TurnedHits&, std::span<const uint32_t> points);

}  // namespace cei3d
