// SPDX-License-Identifier: Apache-2.0
// The operating system beside files (core/base/file.h): the one place to port.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cei3d {

std::string processor_name();          // "unknown" where it cannot be told
double memory_gib();                   // of the machine; 0 where it cannot be told
std::filesystem::path program_file();  // of the running program; empty where it cannot be told

double thread_seconds();   // processor time of the calling thread
double process_seconds();  // processor time of all threads
double peak_memory_gib();  // that the process has had so far

// Gives free pages between the blocks in use back to the system; takes some milliseconds, and as many again
// when they are needed again.
void give_back_freed_memory();

std::string utc_text(const char* format);  // the time now, by a format of strftime

std::string machine_name();  // as other machines may know it; "this-machine" where it cannot be told

bool has_desktop();                                  // a browser can open a window
void open_on_desktop(const std::filesystem::path&);  // with the user's own program for it; does not wait

std::filesystem::path make_temporary_folder();  // a new, empty one

// A lock on a file, held by one process at a time and released when the process ends, however it ends.
class FileLock {
 public:
  // Makes the file where it is missing. None: another process has the lock. Error: it cannot be locked.
  static std::optional<FileLock> take(const std::filesystem::path&);
  ~FileLock();
  FileLock(FileLock&&) noexcept;
  FileLock& operator=(FileLock&&) noexcept;

  // What the file says from now on, for those who cannot have the lock. False: it cannot be written.
  bool write(const std::string& text) const;

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace cei3d
