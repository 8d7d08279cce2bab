// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// The env_brdf of one roughness, tabulated over the viewer's cosine in cells of equal width.
std::vector<Vec2f> env_brdf_table(float roughness);
Vec2f env_brdf_at(const std::vector<Vec2f>& table, float nv);

}  // namespace cei3d
