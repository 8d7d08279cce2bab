// SPDX-License-Identifier: Apache-2.0
// `edit remove`: removes a part and closes the surface behind it.
#pragma once

#include <string>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct RemoveRequest {
  std::string id;  // of the new layer
  std::string part;
};

struct RemoveReport {
  size_t removed_triangles = 0, added_triangles = 0;
  size_t holes = 0;   // closed holes
  size_t pieces = 0;  // connected components of the result
  double seconds = 0;
};

struct RemoveResult {
  EditLayer layer;
  RemoveReport report;
};

// Pure: the scene is not changed. Errors: no such part; a part without surface, or the whole surface.
RemoveResult remove_part(const Device&, const Scene&, const RemoveRequest&, Progress&);

}  // namespace cei3d
