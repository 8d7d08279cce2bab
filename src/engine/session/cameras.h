// SPDX-License-Identifier: Apache-2.0
// Which views to render: a capture's, a file's, or a turntable. Capture frame throughout.
#pragma once

#include <string>
#include <vector>

#include "engine/project/project.h"
#include "engine/session/look_requests.h"

namespace cei3d {

// Errors: no views, unreadable files. size 0: the cameras' own.
std::vector<NamedCamera> choose_cameras(const Project&, const CameraChoice&, int width, int height);

// How the reconstruction read its capture.
CaptureOptions reading_of(const Project&);

// The views of a capture that the choice names: of a split, or of every split; of the project's own capture
// when the path is empty. Splits that the project held out itself count for the same views of a capture
// without splits.
std::vector<View> choose_views(const Project&, const std::filesystem::path& capture,
                               std::optional<Split> split);

// The camera with another image size and the same horizontal field of view.
Camera resized(Camera, int width, int height);

std::vector<NamedCamera> turntable(const Capture&, const Normalization&, int frames);

}  // namespace cei3d
