// SPDX-License-Identifier: Apache-2.0
#include "model/field/optimizer.h"

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/compute/kernels/adam.h"

namespace cei3d {

constexpr float kBeta1 = 0.9f;  // decay of the mean gradient

void Optimizer::add(ParamSet& params, const std::string& prefix, const Group& group) {
  for (Param& p : params.all())
    if (p.name.starts_with(prefix)) {
      const std::vector<float> zeros(p.value.size(), 0.0f);
      slots_.push_back({&p, group, zeros, zeros, zeros});
    }
}

std::span<float> Optimizer::gradient(const Param& param) {
  for (Slot& s : slots_)
    if (s.param == &param) return s.gradient;
  fail("Parameter '{}' is not being optimized (an error in the program).", param.name);
}

void Optimizer::step(const Device& device, float rate_scale) {
  ++steps_;
  constexpr int kGrain = 1 << 16;
  for (Slot& s : slots_) {
    const Group& g = s.group;
    const auto [beta2, eps] = g.adam;
    const double correction = bias_correction(kBeta1, beta2, steps_);
    const AdamStep step{.rate = float(g.rate * rate_scale * correction),
                        .beta1 = kBeta1,
                        .beta2 = beta2,
                        .eps = eps,
                        .skip_zero = g.skip_zero};
    parallel_ranges(int(s.gradient.size()), kGrain, [&](int begin, int end) {
      device.launch<Adam>({.step = step,
                           .value = s.param->value.data() + begin,
                           .gradient = s.gradient.data() + begin,
                           .m = s.m.data() + begin,
                           .v = s.v.data() + begin},
                          end - begin);
    });
  }
}

void Optimizer::save(Tensors& out, const std::string& prefix) const {
  for (size_t i = 0; i < slots_.size(); ++i) {
    const std::string name = prefix + "/" + std::to_string(i);
    const auto n = int64_t(slots_[i].m.size());
    out[name + "/m"] = {{n}, slots_[i].m, {}};
    out[name + "/v"] = {{n}, slots_[i].v, {}};
  }
  out[prefix + "/steps"] = {{1}, {float(steps_)}, {}};
}

void Optimizer::load(const Tensors& in, const std::string& prefix) {
  for (size_t i = 0; i < slots_.size(); ++i) {
    const std::string name = prefix + "/" + std::to_string(i);
    const auto n = int64_t(slots_[i].m.size());
    slots_[i].m = require_tensor(in, name + "/m", {n}).f32;
    slots_[i].v = require_tensor(in, name + "/v", {n}).f32;
  }
  steps_ = int64_t(require_tensor(in, prefix + "/steps", {1}).f32[0]);
}

}  // namespace cei3d
