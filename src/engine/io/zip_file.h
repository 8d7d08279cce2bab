// SPDX-License-Identifier: Apache-2.0
// ZIP archives, as needed for .npz files.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace cei3d {

// All files of an archive by name, unpacked. name: for error messages. Errors: not a ZIP, truncated,
// inconsistent, encrypted, wrong checksums, more than max_bytes in total or in any declared size.
std::map<std::string, std::string> unzip(const std::string& bytes, const std::string& name,
                                         uint64_t max_bytes);

}  // namespace cei3d
