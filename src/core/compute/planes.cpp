// SPDX-License-Identifier: Apache-2.0
#include "core/compute/planes.h"

#include "core/compute/kernels/lobes.h"

namespace cei3d {

std::vector<float> planes_of(std::span<const Vec3f> v, int stride) {
  std::vector<float> p(size_t(3) * stride, 0.0f);
  for (size_t i = 0; i < v.size(); ++i) store_planes(p.data(), stride, int(i), v[i]);
  return p;
}

std::vector<Vec3f> vectors_of(std::span<const float> planes, int stride, size_t n) {
  std::vector<Vec3f> v(n);
  for (size_t i = 0; i < n; ++i) v[i] = load_planes<float>(planes.data(), stride, int(i));
  return v;
}

}  // namespace cei3d
