// SPDX-License-Identifier: Apache-2.0
// Reflection lobes of hits, as the planes that the kernels of core/compute/kernels/shade.h read.
#pragma once

#include <vector>

#include "core/compute/kernels/shade.h"
#include "core/math/reflection_axis.h"
#include "engine/render/hit_batch.h"

namespace cei3d {

class LobeFrames {
 public:
  // stride: number of lobes, in whole panels. Until it is put, a lobe has an axis of length 0.
  explicit LobeFrames(int stride)
      : stride_(stride),
        axes_(size_t(3) * stride, 0.0f),
        across_(size_t(3) * stride, 0.0f),
        normals_(size_t(3) * stride, 0.0f),
        roughness_(size_t(stride), 1.0f),
        stretch_(size_t(stride), 1.0f) {}

  int stride() const { return stride_; }
  void put(size_t i, const LobeFrame<float>& lobe) {
    store_planes(axes_.data(), stride_, int(i), lobe.axis);
    store_planes(across_.data(), stride_, int(i), lobe.across);
    store_planes(normals_.data(), stride_, int(i), lobe.normal);
    roughness_[i] = lobe.roughness;
    stretch_[i] = lobe.stretch;
  }
  LobeFrame<float> get(size_t i) const {
    return {load_planes<float>(axes_.data(), stride_, int(i)),
            load_planes<float>(across_.data(), stride_, int(i)), roughness_[i], stretch_[i],
            load_planes<float>(normals_.data(), stride_, int(i))};
  }

  ReflectionPlanes planes() const {
    return {axes_.data(), across_.data(), normals_.data(), roughness_.data(), stretch_.data()};
  }
  // Where SgReflectionGrad writes.
  float* axes() { return axes_.data(); }
  float* across() { return across_.data(); }
  float* normals() { return normals_.data(); }
  float* roughness() { return roughness_.data(); }
  float* stretch() { return stretch_.data(); }

 private:
  int stride_;
  std::vector<float> axes_, across_, normals_, roughness_, stretch_;
};

// The lobe of a hit in the frame of the light, and back.
inline LobeFrame<float> in_room(const TurnedHits& turned, size_t hit, const LobeFrame<float>& lobe) {
  return {turned.in_room(hit, lobe.axis), turned.in_room(hit, lobe.across), lobe.roughness, lobe.stretch,
          turned.in_room(hit, lobe.normal)};
}
inline LobeFrame<float> in_object(const TurnedHits& turned, size_t hit, const LobeFrame<float>& lobe) {
  return {turned.in_object(hit, lobe.axis), turned.in_object(hit, lobe.across), lobe.roughness, lobe.stretch,
          turned.in_object(hit, lobe.normal)};
}

}  // namespace cei3d
