// SPDX-License-Identifier: Apache-2.0
// Materials and colors of the regions of a synthetic body.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

// A material and an albedo: one color, or two that a pattern in space mixes.
struct Finish {
  Material material;
  Vec3f color{0.5f, 0.5f, 0.5f};        // linear, [0, 1]
  std::optional<Vec3f> second_color{};  // linear; none: plain
};

// At a point of the surface, linear.
Vec3f albedo_at(const Finish&, Vec3f p);

// Mixing weight of the second color at `p`, [0, 1]: soft waves with a few sharp-edged specks.
float pattern_at(Vec3f p);

std::vector<std::string> finish_set_names();
// One finish for each region, by the set's name: "plastic" has one material, "enamel" several. Usage error:
// no such set; the names are listed.
std::vector<Finish> finish_set(const std::string& name, const std::vector<std::string>& regions);

// Usage error: a value out of range; `region` names it in the message.
void require_valid(const Finish&, const std::string& region);

}  // namespace cei3d
