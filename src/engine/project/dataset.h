// SPDX-License-Identifier: Apache-2.0
// dataset.json: the capture as the loader understood it, so that commands on a project need not read the
// capture again.
#pragma once

#include <string>

#include "core/base/json_fwd.h"
#include "model/scene/view.h"

namespace cei3d {

// Cameras stay in the capture's frame. Images are named relative to the capture's folder, whose absolute path
// and whose path relative to the project are both stored: the project is found to fit when either folder
// moves, or both together.
Json dataset_json(const Capture&, const std::filesystem::path& project);
struct Dataset {
  Capture capture;
  std::string fingerprint;  // of the capture when it was reconstructed
};
Dataset dataset_from_json(const Json&, const std::filesystem::path& project);

// Hash of views, cameras and image sizes; the size of a missing image counts as 0.
std::string capture_fingerprint(const Capture&);

}  // namespace cei3d
