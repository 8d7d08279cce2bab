// SPDX-License-Identifier: Apache-2.0
// The results of a catalog as one table, made from its state files.
#pragma once

#include "engine/batch/status.h"

namespace cei3d {

// Writes out: .json, .csv, or .html, which has 500 objects on a page, further pages as NAME-2.html and so on,
// with thumbnails and links to files of the catalog. Failed objects come first, then those whose worst view
// is worst. Returns the number of objects. Error: another suffix.
size_t write_batch_index(const BatchCatalog&, const BatchManifest&, const std::filesystem::path& out);

}  // namespace cei3d
