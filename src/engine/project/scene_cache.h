// SPDX-License-Identifier: Apache-2.0
// A cache of the scenes below each edit of a stack: a stack that shares its first edits with an earlier one
// is built from there. No entry is ever stale, because the key of a scene is the content of everything in it.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/base/lru_cache.h"
#include "model/scene/scene.h"

namespace cei3d {

class SceneCache {
 public:
  static constexpr size_t kMaxBytes = size_t(512) << 20;  // changed surfaces are nearly all of it

  // base_key: content of the base. layer_keys: content of the layers, in order. layer(i): loads layer i;
  // called from the first layer on whose scene is not cached.
  Scene scene(const std::string& base_key, const Scene& base, std::span<const std::string> layer_keys,
              const std::function<EditLayer(size_t)>& layer);

  size_t layers_added() const { return layers_added_; }  // layers loaded so far

 private:
  LruCache<std::string, const Scene> scenes_{kMaxBytes};  // by the hash of the base's and the layers' keys
  size_t layers_added_ = 0;
};

}  // namespace cei3d
