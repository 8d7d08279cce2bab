// SPDX-License-Identifier: Apache-2.0
// An object with other edits: a copy of its project in which they are made.
#pragma once

#include "engine/batch/item.h"
#include "engine/session/session.h"

namespace cei3d {

// The edits, with the histories that they replay written out: what the variant depends on besides the object.
Json variant_inputs(const BatchVariant&, Session&);

// Makes the project `out`; what is there is removed. Returns {"edits": [ids]}. Errors: as
// Session::edit_by_params() and replay().
Json make_variant(const BatchVariant&, const std::filesystem::path& project, const std::filesystem::path& out,
                  Session&, Progress&);

}  // namespace cei3d
