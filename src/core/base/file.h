// SPDX-License-Identifier: Apache-2.0
// Whole files: read at once, written under a temporary name and renamed, so that no reader sees a partial
// file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace cei3d {

// All functions: MachineError when the disk is full or its file system is gone, as far as the system tells.

// All bytes of a file. Errors: missing, a folder, unreadable.
std::string read_file(const std::filesystem::path&);

// Makes missing parent folders, writes "<name>.tmp-<process>-<count>" beside the target, fsyncs, renames. On
// any error (full disk, no permission) the old file is unchanged, the temporary file is removed, and the
// error says why.
void write_file_atomic(const std::filesystem::path&, std::string_view bytes);

struct FileBytes {
  std::filesystem::path path;
  std::string bytes;
};
// Several files that belong together: all are written and synced before the first is renamed, in their order.
// An error before that leaves nothing behind.
void write_files_atomic(std::span<const FileBytes> files);

// Error: no file can be written at that path, as far as can be told without writing. For work that takes long
// before it writes.
void require_writable(const std::filesystem::path&);

// Appends the bytes in one piece, also when several processes append; creates the file if missing. Error: it
// cannot be written.
void append_to_file(const std::filesystem::path&, std::string_view bytes);

// False: there is such a file already, which stays as it is. Of several processes that call it at once, also
// on several machines, one gets true. A reader may see the file before its bytes.
bool write_new_file(const std::filesystem::path&, std::string_view bytes);

bool touch_file(const std::filesystem::path&);  // sets its time to now; false: it cannot, or there is none

// Renames a file or a folder within a file system; a file or an empty folder of that name is replaced.
void move_path(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace cei3d
