// SPDX-License-Identifier: Apache-2.0
// For tests of what is stored of a region.
#pragma once

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "model/geometry/shape/region.h"

namespace cei3d {

// Each stored tensor of a region, missing or one number short, is an error.
inline void expect_damage_is_refused(const Region& region) {
  Tensors tensors;
  Json head;
  region.save(tensors, head);
  for (const auto& [name, t] : tensors) {
    Tensors damaged = tensors;
    damaged.erase(name);
    EXPECT_THROW(Region::load(damaged, head), Error) << name;
    damaged = tensors;
    damaged[name].f32.pop_back();
    EXPECT_THROW(Region::load(damaged, head), Error) << name;
  }
}

}  // namespace cei3d
