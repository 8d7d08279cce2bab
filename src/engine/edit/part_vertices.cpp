// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_vertices.h"

#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

const EditLayer& layer_of_part(const Scene& scene, const std::string& part) {
  std::set<std::string> names;
  for (auto layer = scene.layers.rbegin(); layer != scene.layers.rend(); ++layer) {
    if (!layer->part.empty() && layer->part == part) return *layer;
    if (!layer->part.empty()) names.insert("'" + layer->part + "'");
  }
  if (names.empty())
    fail_usage("There is no part '{}'; make one with `cei3d edit PROJECT part --name {}`.", part, part);
  fail_usage("There is no part '{}'; there are {}.", part, fmt::join(names, ", "));
}

}  // namespace

std::vector<uint8_t> part_vertices(const Scene& scene, const std::string& part) {
  const EditLayer& layer = layer_of_part(scene, part);
  const std::vector<Hit> hits = vertex_hits(scene.surface->mesh());
  std::vector<uint8_t> inside(hits.size(), 0);
  parallel_ranges(int(hits.size()), 1024, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const bool later = !scene.poses.empty() && scene.poses.back()->born_in(hits[v].triangle) > layer.pose;
      if (later) continue;  // matter that was not there when the part was chosen
      const SurfacePoint p = in_pose(scene.poses, hits[v], layer.pose);
      inside[v] = layer.contains(p.position, p.normal);
    }
  });
  return inside;
}

}  // namespace cei3d
