// SPDX-License-Identifier: Apache-2.0
// Cameras in JSON: of a project's views, of edits, and of `--camera`.
#pragma once

#include "core/base/json_reader.h"
#include "core/math/camera.h"

namespace cei3d {

Json camera_json(const Camera&);
Camera camera_from_json(JsonReader&);  // reads the keys of camera_json(); `skew` may be missing, then it is 0

}  // namespace cei3d
