// SPDX-License-Identifier: Apache-2.0
#include "engine/project/scene_cache.h"

#include <set>
#include <vector>

#include "core/base/hash.h"

namespace cei3d {
namespace {

// Bytes that the scene does not share with the one below: a new surface with its ray index, or a copy of the
// list of layers.
size_t own_bytes(const Scene& scene) {
  constexpr size_t kLayer = size_t(64) << 10, kRayIndexPerTriangle = 96;
  size_t bytes = scene.layers.size() * kLayer;
  if (!scene.layers.empty() && scene.layers.back().reshape) {
    const Surface& s = *scene.surface;
    bytes += s.visibility().size() + s.mesh().positions.size() * (2 * sizeof(Vec3f) + sizeof(Mat3f)) +
             s.mesh().triangles.size() * kRayIndexPerTriangle;
  }
  return bytes;
}

}  // namespace

Scene SceneCache::scene(const std::string& base_key, const Scene& base,
                        std::span<const std::string> layer_keys,
                        const std::function<EditLayer(size_t)>& layer) {
  std::vector<std::string> keys;  // of the scenes above each layer
  for (const std::string& k : layer_keys)
    keys.push_back(content_hash((keys.empty() ? base_key : keys.back()) + k));
  size_t done = keys.size();
  Scene scene = base;
  for (; done > 0; --done)
    if (const auto kept = scenes_.find(keys[done - 1])) {
      scene = *kept;
      break;
    }
  for (; done < keys.size(); ++done) {
    scene = with_layer(std::move(scene), kept(layer_keys[done], done, layer));
    if (scene.layers.back().reshape || done + 1 == keys.size())
      scenes_.put(keys[done], std::make_shared<const Scene>(scene), own_bytes(scene));
  }
  drop_others(layer_keys);
  return scene;
}

const EditLayer& SceneCache::kept(const std::string& key, size_t i,
                                  const std::function<EditLayer(size_t)>& layer) {
  const auto known = layers_.find(key);
  if (known != layers_.end()) return known->second;
  ++layers_loaded_;
  return layers_.emplace(key, layer(i)).first->second;
}

// Forgets layers that this stack does not have, but for a few that the next one may need.
void SceneCache::drop_others(std::span<const std::string> layer_keys) {
  constexpr size_t kFew = 64;
  if (layers_.size() <= layer_keys.size() + kFew) return;
  const std::set<std::string> used(layer_keys.begin(), layer_keys.end());
  std::erase_if(layers_, [&](const auto& l) { return !used.contains(l.first); });
}

}  // namespace cei3d
