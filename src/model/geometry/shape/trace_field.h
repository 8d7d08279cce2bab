// SPDX-License-Identifier: Apache-2.0
// Rays against the zero set of a field itself, without a mesh: sphere tracing, whose steps are the distance,
// then bisection between the last point outside and the first inside. [Hart 1996]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/math/camera.h"
#include "model/field/field.h"

namespace cei3d {

struct FieldTrace {
  bool hit = false;
  float depth = 0;  // of the hit; of a miss, where the smallest value was met, near that of lowest_along()
  float value = 0;  // of the field there; of a hit within kTraceTolerance of 0
};

inline constexpr float kTraceTolerance = 2e-6f;  // unit frame

// Traces rays within the unit sphere. starts: empty, or #rays: depth near which the surface is expected, such
// as that of a mesh; <= 0: unknown. If the surface is not there, the whole ray is searched. Sheets thinner
// than 0.001 may be missed. A ray that misses the unit sphere has the depth of its point nearest to the
// origin. A ray that begins inside the surface hits where it begins.
std::vector<FieldTrace> trace_field(const Device&, const Field& sdf, std::span<const Ray> rays,
                                    std::span<const float> starts = {});

// The point of each ray, within the unit sphere, at which the field is smallest, among 48 samples; hit:
// whether it is inside. For mask losses, which push it outside or pull it inside.
std::vector<FieldTrace> lowest_along(const Device&, const Field& sdf, std::span<const Ray> rays);

}  // namespace cei3d
