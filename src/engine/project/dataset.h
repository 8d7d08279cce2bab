// SPDX-License-Identifier: Apache-2.0
// dataset.json: the capture as we understood it, so that verbs on a project need not read the capture again.
#pragma once

#include <string>

#include "core/base/json_reader.h"
#include "model/scene/view.h"

namespace cei3d {

// Cameras stay in the capture's frame. Pictures are named relative to the capture's folder, whose absolute
// path and whose path relative to the project stand beside each other: either may move, or both together.
Json dataset_json(const Capture&, const std::filesystem::path& project);
struct Dataset {
  Capture capture;
  std::string fingerprint;  // of the capture when it was reconstructed
};
Dataset dataset_from_json(const Json&, const std::filesystem::path& project);

// Changes when a view, a camera or the size of a picture changes. Pictures that are missing count as size 0.
std::string capture_fingerprint(const Capture&);

Json camera_json(const Camera&);
Camera camera_from_json(JsonReader&);  // reads the keys of camera_json()

}  // namespace cei3d
