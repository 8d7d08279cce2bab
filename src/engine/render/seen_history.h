// SPDX-License-Identifier: Apache-2.0
// The materials of the vertices of a shape version after each layer. A point that was last edited by some
// layer reflects the vertices with the materials that they have after that layer. Only what each layer
// changes is kept, so that many small edits take little room.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/lru_cache.h"
#include "core/base/run_list.h"
#include "engine/render/vertex_light.h"
#include "model/scene/scene.h"

namespace cei3d {

// Identifies the materials of all vertices of a shape version: equal ids mean equal bits. It is a sum of
// hashes over the vertices, so that a change of a few costs little.
struct SeenId {
  uint64_t a = 0, b = 0;
  bool operator==(const SeenId&) const = default;
};

// What a layer changes.
struct SeenChange {
  std::string content;  // EditLayer::content
  // The vertices whose materials the layer changes, ascending: the k-th has the index vertex_offset[k] + k,
  // so that successive ones make a run. Their values are those after the layer.
  RunList<uint32_t> vertex_offset;
  RunList<Vec3f> albedo;
  RunList<Material> material;
  SeenId id;  // of the materials of all vertices after the layer

  size_t bytes() const;
};

class SeenHistory {
 public:
  explicit SeenHistory(VertexMaterials as_reconstructed);
  // Whether it has the changes of the scene's layers up to `last`. It may have those of later layers, too.
  bool reaches(const Scene& scene, int last) const { return common_layers(scene, last) == size_t(last + 1); }
  // A history that has the changes of the scene's layers up to `last`. Those of the first layers, as far as
  // this one has the same, are taken from here. version: the shape version.
  SeenHistory through(const Device&, const Scene&, int last, int version) const;

  // Of the materials after the layer; -1: of those as reconstructed.
  SeenId id(int layer) const { return layer < 0 ? id_ : changes_[size_t(layer)]->id; }
  size_t bytes() const { return bytes_; }

  // The materials after a layer. Layers are asked for in ascending order.
  class Walk {
   public:
    explicit Walk(const SeenHistory& history) : history_(history), now_(*history.rest_) {}
    const VertexMaterials& after(int layer);

   private:
    const SeenHistory& history_;
    VertexMaterials now_;
    size_t next_ = 0;  // the first layer whose change is not in now_
  };

 private:
  // How many of the scene's first layers, up to `last`, are the first layers of this history.
  size_t common_layers(const Scene&, int last) const;

  std::shared_ptr<const VertexMaterials> rest_;             // as reconstructed
  SeenId id_;                                               // of rest_
  std::vector<std::shared_ptr<const SeenChange>> changes_;  // by layer
  size_t bytes_ = 0;
};

// Everything that a history depends on besides the layers.
struct SeenHistoryKey {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Field> albedo;
  MaterialField material;
  bool operator==(const SeenHistoryKey&) const = default;
};
using SeenHistories = LruCache<SeenHistoryKey, const SeenHistory>;

}  // namespace cei3d
