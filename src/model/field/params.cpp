// SPDX-License-Identifier: Apache-2.0
#include "model/field/params.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/compute/linear.h"

namespace cei3d {

size_t Param::count() const {
  size_t n = 1;
  for (int64_t d : shape) n *= size_t(d);
  return n;
}

Param& ParamSet::add(std::string name, std::vector<int64_t> shape) {
  Param& p = params_.emplace_back(Param{std::move(name), std::move(shape), {}});
  p.value.assign(size_t(padded_to_panels(int(p.count()))), 0.0f);
  return p;
}

const Param& ParamSet::get(const std::string& name) const {
  for (const Param& p : params_)
    if (p.name == name) return p;
  fail("There is no parameter '{}' (an error in the program).", name);
}
Param& ParamSet::get(const std::string& name) { return const_cast<Param&>(std::as_const(*this).get(name)); }

void ParamSet::save(Tensors& out, const std::string& prefix) const {
  for (const Param& p : params_) {
    Tensor& t = out[prefix + "/" + p.name];
    t.shape = p.shape;
    t.f32.assign(p.value.begin(), p.value.begin() + std::ptrdiff_t(p.count()));
  }
}

void ParamSet::load(const Tensors& in, const std::string& prefix) {
  for (Param& p : params_) {
    const Tensor& t = require_tensor(in, prefix + "/" + p.name, p.shape);
    std::copy(t.f32.begin(), t.f32.end(), p.value.begin());
  }
}

}  // namespace cei3d
