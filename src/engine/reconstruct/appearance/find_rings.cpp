// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/find_rings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "core/math/rigid_motion.h"

namespace cei3d {
namespace {

constexpr float kSameRing = 0.06f;                 // radians, CameraRing::tilt()
constexpr double kMinTurn = 0.03, kMaxTurn = 1.5;  // radians between two photographs of a ring
constexpr size_t kFewest = 6;                      // photographs of a ring
constexpr size_t kMostRings = 6;
constexpr double kInNone = 0.05;  // share of the cameras, at most

using Indices = std::vector<size_t>;

Vec3d right_of(const Camera& c) { return transpose(c.world_from_cam).row[0]; }
Vec3d down_of(const Camera& c) { return transpose(c.world_from_cam).row[1]; }
Vec3d forward_of(const Camera& c) { return transpose(c.world_from_cam).row[2]; }

// None: the object has hardly turned between the photographs, or very far.
std::optional<CameraRing> ring_through(const Camera& a, const Camera& b) {
  const Vec3d turn = turn_of(b.world_from_cam * transpose(a.world_from_cam));
  const double angle = length(turn);
  if (angle < kMinTurn || angle > kMaxTurn) return {};
  const Vec3d axis = turn / (dot(turn, down_of(a)) > 0 ? -angle : angle);
  return CameraRing{to_float(axis), float(dot(forward_of(a), axis)), float(dot(right_of(a), axis))};
}

Indices members_of(const CameraRing& ring, std::span<const Camera> cameras, const Indices& asked) {
  Indices out;
  for (const size_t i : asked)
    if (ring.tilt(to_float(cameras[i].world_from_cam)) < kSameRing) out.push_back(i);
  return out;
}

// The axis along which the directions of the cameras change least.
CameraRing ring_of(std::span<const Camera> cameras, const Indices& members, const CameraRing& rough) {
  const auto vec = [](Vec3d v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  const auto n = double(members.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_right = Eigen::Vector3d::Zero(), mean_forward = Eigen::Vector3d::Zero();
  for (const size_t i : members) {
    mean_right += vec(right_of(cameras[i])) / n;
    mean_forward += vec(forward_of(cameras[i])) / n;
  }
  for (const size_t i : members)
    for (const Eigen::Vector3d& d : {Eigen::Vector3d(vec(right_of(cameras[i])) - mean_right),
                                     Eigen::Vector3d(vec(forward_of(cameras[i])) - mean_forward)})
      spread += d * d.transpose();
  Eigen::Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  if (axis.dot(vec(to_double(rough.axis))) < 0) axis = -axis;
  return {{float(axis.x()), float(axis.y()), float(axis.z())},
          float(axis.dot(mean_forward)),
          float(axis.dot(mean_right))};
}

// The ring that has most of the cameras; none: it has few.
std::optional<CameraRing> largest_ring(std::span<const Camera> cameras, const Indices& left) {
  std::optional<CameraRing> rough;
  Indices most;
  for (size_t k = 0; k + 1 < left.size(); ++k) {
    const std::optional<CameraRing> ring = ring_through(cameras[left[k]], cameras[left[k + 1]]);
    if (!ring) continue;
    Indices members = members_of(*ring, cameras, left);
    if (members.size() > most.size()) most = std::move(members), rough = ring;
  }
  if (most.size() < kFewest) return {};
  return ring_of(cameras, most, *rough);
}

}  // namespace

std::vector<CameraRing> find_rings(std::span<const Camera> cameras) {
  Indices left;
  for (size_t i = 0; i < cameras.size(); ++i) left.push_back(i);
  std::vector<CameraRing> rings;
  while (const std::optional<CameraRing> ring = largest_ring(cameras, left)) {
    const Indices members = members_of(*ring, cameras, left);
    if (members.size() < kFewest || rings.size() == kMostRings) break;
    std::erase_if(left, [&](size_t i) { return std::binary_search(members.begin(), members.end(), i); });
    rings.push_back(*ring);
  }
  if (rings.size() < 2 || double(left.size()) > kInNone * double(cameras.size())) return {};
  return rings;
}

}  // namespace cei3d
