// SPDX-License-Identifier: Apache-2.0
// Named parameters of a model, the only owner of weights, so that saving, hashing and optimizing need no code
// per network.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/tensors.h"

namespace cei3d {

struct Param {
  std::string name;
  std::vector<int64_t> shape;
  // Padded with zeros to a multiple of 32 floats, so that kernels need no remainder
  std::vector<float> value;

  size_t count() const;  // product of the shape
};

class ParamSet {
 public:
  Param& add(std::string name, std::vector<int64_t> shape);
  Param& get(const std::string& name);  // error when there is none
  const Param& get(const std::string& name) const;
  std::vector<Param>& all() { return params_; }
  const std::vector<Param>& all() const { return params_; }

  void save(Tensors& out, const std::string& prefix) const;  // "prefix/name"
  void load(const Tensors& in, const std::string& prefix);   // error on a missing name or another shape

 private:
  std::vector<Param> params_;
};

}  // namespace cei3d
