// SPDX-License-Identifier: Apache-2.0
#include "engine/session/edit_ops.h"

#include "core/base/error.h"

namespace cei3d {

const EditOp& edit_op(const std::string& name) {
  for (const EditOp* op : {&kPaintOp, &kMaterialOp, &kLightOp, &kDeformOp, &kRemoveOp, &kPartOp})
    if (name == op->name) return *op;
  fail("'{}' is an edit that this program does not know; update cei3d.", name);
}

const std::string& EditJob::input(const std::string& name) const {
  for (const auto& [n, bytes] : inputs)
    if (n == name) return bytes;
  fail("Edit {} lacks its input {}; the project is damaged.", id, name);
}

}  // namespace cei3d
