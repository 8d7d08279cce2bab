// SPDX-License-Identifier: Apache-2.0
// ZIP archives, as far as .npz files need them.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace cei3d {

// All files of an archive by name, unpacked. `name` is for the sentences. Errors: not a ZIP, truncated,
// inconsistent, encrypted, wrong checksums, more than max_bytes in all or in any declared size.
std::map<std::string, std::string> unzip(const std::string& bytes, const std::string& name,
                                         uint64_t max_bytes);

}  // namespace cei3d
