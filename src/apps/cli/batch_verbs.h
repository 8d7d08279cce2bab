// SPDX-License-Identifier: Apache-2.0
// The commands of `batch` that are not in cmd_batch.cpp.
#pragma once

#include "apps/cli/command.h"

namespace cei3d {

void add_batch_looks(Commands&, CLI::App* batch);  // status, retry, cancel, index

}  // namespace cei3d
