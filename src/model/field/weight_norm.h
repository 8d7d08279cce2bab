// SPDX-License-Identifier: Apache-2.0
// Weight normalization: each row w of a layer's weights is g v / |v|, and the descent is on g and v, so that
// the length of a row and its direction are learned apart. [Salimans and Kingma 2016]
#pragma once

#include <string>
#include <vector>

#include "model/field/adam_constants.h"
#include "model/field/field.h"
#include "model/field/optimizer.h"

namespace cei3d {

class WeightNorm {
 public:
  // Of all layers of the field, which must outlive the object; it begins as it is, up to rounding. Fields
  // with hash tables keep those as they are. rate: of Adam.
  WeightNorm(Field& field, float rate, AdamConstants adam);

  // A step by the gradients that `trainer`, of the same field, has accumulated, which it forgets.
  void update(const Device&, FieldTrainer& trainer, float rate);

  void save(Tensors& out, const std::string& prefix) const;
  void load(const Tensors& in, const std::string& prefix);  // and sets the field's layers

 private:
  struct Layer {
    Param *weight, *bias;             // of the field
    size_t direction, length, shift;  // places in own_ of v [out][in], g [out] and the bias [out]
  };
  void set_field();

  std::vector<Layer> layers_;
  ParamSet own_;
  Optimizer optimizer_;
};

}  // namespace cei3d
