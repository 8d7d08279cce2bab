// SPDX-License-Identifier: Apache-2.0
#include "engine/session/edit_ops.h"

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/project/project.h"

namespace cei3d {

const EditOp& edit_op(const std::string& name) {
  for (const EditOp* op : {&kPaintOp, &kMaterialOp, &kLightOp, &kDeformOp, &kRemoveOp, &kPartOp})
    if (name == op->name) return *op;
  fail("'{}' is an edit that this program does not know; update cei3d.", name);
}

Json present_params(const EditOp& op, const EditRecord& record) {
  if (record.op_version > op.version)
    fail(
        "Edit {} was made by version {} of '{}', and this program has version {}: it cannot be remade; "
        "update cei3d.",
        record.id, record.op_version, op.name, op.version);
  if (record.op_version < 1) fail("Edit {} has the invalid version {}.", record.id, record.op_version);
  return record.op_version < op.version && op.migrate ? op.migrate(record.params, record.op_version)
                                                      : record.params;
}

const std::string& EditJob::input(const std::string& name) const {
  for (const auto& [n, bytes] : inputs)
    if (n == name) return bytes;
  fail("Edit {} lacks its input {}; the project is damaged.", id, name);
}

}  // namespace cei3d
