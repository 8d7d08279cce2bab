// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "model/geometry/mesh/patch.h"

namespace cei3d {
namespace {

// Liepa's alpha: triangles about as large as those around.
constexpr float kDensity = std::numbers::sqrt2_v<float>;

// Triangles that can be split at their centroid and have their inner edges flipped.
class Refinement {
 public:
  Refinement(std::span<const Vec3f> loop, const IsJoined& joined)
      : patch_{{loop.begin(), loop.end()}, triangulate_loop(loop, joined)},
        loop_(uint32_t(loop.size())),
        joined_(joined) {
    for (uint32_t i = 0; i < loop_; ++i)
      size_.push_back(
          0.5f * (length(loop[(i + 1) % loop_] - loop[i]) + length(loop[i] - loop[(i + loop_ - 1) % loop_])));
    for (uint32_t t = 0; t < patch_.triangles.size(); ++t) enter(t);
  }

  Patch run() {
    relax();
    // Each round splits all triangles that are too large, so sizes shrink geometrically.
    constexpr int kMaxRounds = 40;
    for (int round = 0; round < kMaxRounds && split_large(); ++round) relax();
    return std::move(patch_);
  }

 private:
  using Triangle = std::array<uint32_t, 3>;
  static uint64_t key(uint32_t a, uint32_t b) { return uint64_t(a) << 32 | b; }

  void enter(uint32_t t) {
    const Triangle& v = patch_.triangles[t];
    for (int k = 0; k < 3; ++k) triangle_of_[key(v[k], v[(k + 1) % 3])] = t;
  }
  void leave(uint32_t t) {
    const Triangle& v = patch_.triangles[t];
    for (int k = 0; k < 3; ++k) triangle_of_.erase(key(v[k], v[(k + 1) % 3]));
  }
  void replace(uint32_t t, Triangle with) {
    patch_.triangles[t] = with;
    enter(t);
  }
  bool is_edge(uint32_t a, uint32_t b) const {
    return triangle_of_.count(key(a, b)) || triangle_of_.count(key(b, a)) ||
           (a < loop_ && b < loop_ && joined_(a, b));
  }

  bool split_large() {
    bool any = false;
    const size_t before = patch_.triangles.size();
    for (uint32_t t = 0; t < before; ++t) any |= split(t);
    return any;
  }

  bool split(uint32_t t) {
    const auto [a, b, c] = patch_.triangles[t];
    const std::vector<Vec3f>& p = patch_.positions;
    const Vec3f center = (p[a] + p[b] + p[c]) / 3.0f;
    const float size = (size_[a] + size_[b] + size_[c]) / 3.0f;
    for (const uint32_t v : {a, b, c}) {
      const float reach = kDensity * length(p[v] - center);
      if (reach <= size || reach <= size_[v]) return false;
    }
    const uint32_t m = uint32_t(p.size());
    patch_.positions.push_back(center);
    size_.push_back(size);
    leave(t);
    replace(t, {a, b, m});
    for (const Triangle& more : {Triangle{b, c, m}, Triangle{c, a, m}}) {
      patch_.triangles.push_back(more);
      enter(uint32_t(patch_.triangles.size() - 1));
    }
    // Splits all triangles at once; otherwise the centroids of two slivers along one edge would come too
    // close to each other.
    improve(a, b);
    improve(b, c);
    improve(c, a);
    return true;
  }

  // Flips edges until none is worse than the other diagonal. The number of rounds is bounded, because flips
  // in space may cycle.
  void relax() {
    for (int sweep = 0; sweep < 30; ++sweep) {
      bool any = false;
      for (uint32_t t = 0; t < patch_.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) any |= improve(patch_.triangles[t][k], patch_.triangles[t][(k + 1) % 3]);
      if (!any) return;
    }
  }

  static uint32_t apex(const Triangle& t, uint32_t a, uint32_t b) {
    return t[0] != a && t[0] != b ? t[0] : t[1] != a && t[1] != b ? t[1] : t[2];
  }

  // Flips a -> b if the angles opposite to it are more than 180 degrees.
  bool improve(uint32_t a, uint32_t b) {
    const auto here = triangle_of_.find(key(a, b)), there = triangle_of_.find(key(b, a));
    if (here == triangle_of_.end() || there == triangle_of_.end()) return false;  // a side of the loop
    const uint32_t t = here->second, s = there->second;
    const uint32_t c = apex(patch_.triangles[t], a, b), d = apex(patch_.triangles[s], a, b);
    if (angle(c, a, b) + angle(d, a, b) <= kPi + 1e-4f || is_edge(c, d)) return false;
    leave(t);
    leave(s);
    replace(t, {a, d, c});
    replace(s, {b, c, d});
    return true;
  }

  float angle(uint32_t at, uint32_t a, uint32_t b) const {
    const Vec3f u = patch_.positions[a] - patch_.positions[at],
                v = patch_.positions[b] - patch_.positions[at];
    return std::atan2(length(cross(u, v)), dot(u, v));
  }

  Patch patch_;
  uint32_t loop_;
  const IsJoined& joined_;
  std::vector<float> size_;                             // wanted length of edges at each vertex
  std::unordered_map<uint64_t, uint32_t> triangle_of_;  // of a directed edge; never iterated over
};

}  // namespace

Patch fill_loop(std::span<const Vec3f> loop, const IsJoined& joined) {
  return Refinement(loop, joined).run();
}

}  // namespace cei3d
