// SPDX-License-Identifier: Apache-2.0
#include "model/scene/parts.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {

std::vector<std::string> part_names(const Scene& scene) {
  std::set<std::string> names;
  for (const EditLayer& l : scene.layers)
    if (!l.part.empty()) names.insert(l.part);
  return {names.begin(), names.end()};
}

const EditLayer& part_layer(const Scene& scene, const std::string& part) {
  for (auto l = scene.layers.rbegin(); l != scene.layers.rend(); ++l)
    if (!l->part.empty() && l->part == part) return *l;
  std::string names;
  for (const std::string& name : part_names(scene)) names += (names.empty() ? "'" : ", '") + name + "'";
  if (names.empty()) fail_usage("There is no part '{}'; select one and give it that name first.", part);
  fail_usage("There is no part '{}'; there are {}.", part, names);
}

std::vector<uint8_t> inside_layer(const Scene& scene, const EditLayer& layer, std::span<const Hit> hits) {
  std::vector<uint8_t> inside(hits.size(), 0);
  const int version = max(layer.shape_version, 0);
  parallel_ranges(int(hits.size()), 1024, [&](int begin, int end) {
    LayerWeights weights(layer);
    for (int i = begin; i < end; ++i) {
      if (!scene.shape_versions.empty() && scene.shape_versions.back()->born_in(hits[i].triangle) > version)
        continue;
      const SurfacePoint p = in_version(scene.shape_versions, hits[i], version);
      inside[i] = weights.at(p.position, p.normal) > 0;
    }
  });
  return inside;
}

PartsOfHits parts_of(const Scene& scene, std::span<const Hit> hits) {
  constexpr size_t kMax = 256;
  std::vector<const EditLayer*> layers;
  for (const std::string& name : part_names(scene)) layers.push_back(&part_layer(scene, name));
  std::sort(layers.begin(), layers.end());  // in the order of the scene's
  PartsOfHits out;
  out.of.resize(hits.size(), 0);
  for (const EditLayer* layer : layers) {
    if (out.names.size() == kMax) break;
    const std::vector<uint8_t> inside = inside_layer(scene, *layer, hits);
    for (size_t i = 0; i < hits.size(); ++i)
      if (inside[i]) out.of[i] = uint8_t(out.names.size());
    out.names.push_back(layer->part);
  }
  return out;
}

}  // namespace cei3d
