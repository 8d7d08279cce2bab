// SPDX-License-Identifier: Apache-2.0
#include "engine/project/lock.h"

namespace cei3d {

ProjectLock::ProjectLock(const std::filesystem::path& folder) : lock_(FileLock::take(folder / ".lock")) {
  if (!lock_)
    throw InUseError(fmt::format(
        "Project {} is in use by another cei3d that changes it; wait until that is done, or stop it.",
        folder.string()));
}

}  // namespace cei3d
