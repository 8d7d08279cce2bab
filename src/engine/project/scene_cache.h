// SPDX-License-Identifier: Apache-2.0
// Scenes of a stack of edits, made of layers in memory: a stack that shares its first edits with an earlier
// one is built from there. No entry is ever stale, because the key of a scene is the content of everything in
// it.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>

#include "core/base/lru_cache.h"
#include "model/scene/scene.h"

namespace cei3d {

class SceneCache {
 public:
  static constexpr size_t kMaxBytes = size_t(512) << 20;  // changed surfaces are nearly all of it

  // base_key: content of the base. layer_keys: content of the layers, in order. layer(i): loads layer i;
  // called for those that are not in memory.
  Scene scene(const std::string& base_key, const Scene& base, std::span<const std::string> layer_keys,
              const std::function<EditLayer(size_t)>& layer);

  size_t layers_loaded() const { return layers_loaded_; }  // so far

 private:
  const EditLayer& kept(const std::string& key, size_t i, const std::function<EditLayer(size_t)>& layer);
  void drop_others(std::span<const std::string> layer_keys);

  // Whole stacks, and what is below changes of shape; by the hash of the base's and the layers' keys.
  LruCache<std::string, const Scene> scenes_{kMaxBytes};
  std::map<std::string, EditLayer> layers_;  // by content
  size_t layers_loaded_ = 0;
};

}  // namespace cei3d
