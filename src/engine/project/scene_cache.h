// SPDX-License-Identifier: Apache-2.0
// The scenes that a stack of edits passes through, kept in memory: a stack that begins as one before it is
// built from where the two part. Nothing is ever stale, because a scene's key is the content of all that it
// is made of.
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

  // base_key: content of the base. layer_keys: content of the layers, in order. layer(i): called for those
  // from the first on that no scene is kept for.
  Scene scene(const std::string& base_key, const Scene& base, std::span<const std::string> layer_keys,
              const std::function<EditLayer(size_t)>& layer);

  size_t layers_added() const { return layers_added_; }  // since the beginning: the work that was done

 private:
  LruCache<std::string, const Scene> scenes_{kMaxBytes};  // by the hash of the base's and the layers' keys
  size_t layers_added_ = 0;
};

}  // namespace cei3d
