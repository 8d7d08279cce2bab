// SPDX-License-Identifier: Apache-2.0
// The table of a catalog as pages.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

// rows: as in index.json, in the order in which they are shown. The second page is called NAME-2.html, and so
// on.
void write_index_pages(const std::vector<Json>& rows, const std::filesystem::path& catalog,
                       const std::filesystem::path& out);

}  // namespace cei3d
