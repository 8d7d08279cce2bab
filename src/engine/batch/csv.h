// SPDX-License-Identifier: Apache-2.0
// Tables as text with commas [RFC 4180].
#pragma once

#include <string>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

// The fields of each line; quoted fields may hold commas, line ends and doubled quotes. Error: a quote that
// is not closed.
std::vector<std::vector<std::string>> csv_table(const std::string& text, const std::string& what);
std::string csv_line(const std::vector<std::string>& fields);

// Lines of a manifest (manifest.h). Errors: no head line, an unknown column, a field that is no number.
std::vector<Json> lines_of_csv(const std::string& text, const std::string& what);

}  // namespace cei3d
