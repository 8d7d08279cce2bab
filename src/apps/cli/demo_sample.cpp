// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/demo_sample.h"

#include "core/base/error.h"

namespace cei3d {

std::filesystem::path demo_sample(const std::filesystem::path& program) {
  const auto is_sample = [](const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / "transforms_train.json");
  };
  const std::filesystem::path folder = program.parent_path();
  const std::filesystem::path installed = folder.parent_path() / "share/cei3d/samples/spot";
  if (is_sample(installed)) return installed;
  for (std::filesystem::path above = folder; above.has_relative_path(); above = above.parent_path())
    if (is_sample(above / "samples/spot")) return above / "samples/spot";
  throw Error(
      ErrorCode::failed,
      fmt::format("The sample capture is missing: it is neither {} nor samples/spot in a folder above {}",
                  installed.string(), program.string()),
      "Install the package again, or name a copy of the folder samples/spot: cei3d demo --sample FOLDER.");
}

}  // namespace cei3d
