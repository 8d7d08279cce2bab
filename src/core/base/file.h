// SPDX-License-Identifier: Apache-2.0
// Whole files: read at once, written under a temporary name and renamed, so that nobody ever sees half a
// file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace cei3d {

// All bytes of a file. Errors: missing, a folder, unreadable.
std::string read_file(const std::filesystem::path&);

// Makes missing parent folders, writes "<name>.tmp-<process>-<count>" beside the target, fsyncs, renames.
// Whatever goes wrong (full disk, no permission), the old file stands untouched, no temporary file stays, and
// the error says why.
void write_file_atomic(const std::filesystem::path&, std::string_view bytes);

// In one piece at the end, also where several processes write; makes the file where it is missing. Error: it
// cannot be written.
void append_to_file(const std::filesystem::path&, std::string_view bytes);

}  // namespace cei3d
