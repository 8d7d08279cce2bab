// SPDX-License-Identifier: Apache-2.0
#include "engine/render/env_table.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/math/brdf.h"

namespace cei3d {
namespace {
constexpr int kEnvCells = 64;
}

std::vector<Vec2f> env_brdf_table(float roughness) {
  std::vector<Vec2f> table(kEnvCells);
  parallel_ranges(kEnvCells, 8, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const EnvBrdf e = env_brdf(roughness, (i + 0.5) / kEnvCells);
      table[i] = {e.scale, e.bias};
    }
  });
  return table;
}

Vec2f env_brdf_at(const std::vector<Vec2f>& table, float nv) {
  const float x = clamp(nv * float(table.size()) - 0.5f, 0.0f, float(table.size() - 1));
  const int i = std::min(int(x), int(table.size()) - 2);
  const float f = x - float(i);
  return {table[i].x * (1 - f) + table[i + 1].x * f, table[i].y * (1 - f) + table[i + 1].y * f};
}

}  // namespace cei3d
