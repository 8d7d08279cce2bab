// SPDX-License-Identifier: Apache-2.0
// Adam over the parameters of one or more models.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/field/adam_constants.h"
#include "model/field/params.h"

namespace cei3d {

class Optimizer {
 public:
  struct Group {
    float rate = 1e-3f;
    AdamConstants adam{};
    bool skip_zero = false;  // see AdamStep
  };
  // params must outlive the optimizer. The group has the parameters whose names begin with `prefix` ("":
  // all).
  void add(ParamSet& params, const std::string& prefix, const Group& group);

  std::span<float> gradient(const Param& param);  // the caller adds to it; step() clears it
  void step(const Device&, float rate_scale);     // rate_scale multiplies every group's rate (schedule)

  void save(Tensors& out, const std::string& prefix) const;  // moments and the step count
  void load(const Tensors& in, const std::string& prefix);

 private:
  struct Slot {
    Param* param;
    Group group;
    std::vector<float> gradient, m, v;
  };
  std::vector<Slot> slots_;
  int64_t steps_ = 0;
};

}  // namespace cei3d
