// SPDX-License-Identifier: Apache-2.0
#include "engine/project/lock.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace cei3d {
namespace {

// What the lock file says; empty where that is no address: other programs may write there, too.
std::string address_in(const std::filesystem::path& file) {
  std::array<char, 100> start{};
  std::ifstream in(file);
  in.read(start.data(), start.size());
  const std::string text(start.data(), size_t(in.gcount()));
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; }) ? text : "";
}

InUseError in_use(const std::filesystem::path& folder) {
  const std::string start =
      fmt::format("Project {} is in use by another cei3d that changes it", folder.string());
  const std::string address = address_in(folder / ".lock");
  if (address.empty()) return InUseError(start + "; wait until that is done, or stop it.");
  return InUseError(start + ", the editor at " + address + "; make the change there, or end that editor.");
}

}  // namespace

ProjectLock::ProjectLock(const std::filesystem::path& folder) : lock_(FileLock::take(folder / ".lock")) {
  if (!lock_) throw in_use(folder);
  lock_->write("");  // the address of an editor that ended
}

void ProjectLock::say_address(const std::string& address) const {
  if (lock_) lock_->write(address);
}

}  // namespace cei3d
