// SPDX-License-Identifier: Apache-2.0
// Materials of the vertices of a shape version after each layer: what surface that was last edited then sees
// in its reflections. They are kept as what each layer changes, so that many small edits take little room.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/lru_cache.h"
#include "engine/render/vertex_light.h"
#include "model/scene/scene.h"

namespace cei3d {

// Names the materials of all vertices of a shape version: equal ids, equal bits. A sum over the vertices.
struct SeenId {
  uint64_t a = 0, b = 0;
  bool operator==(const SeenId&) const = default;
};

// What a layer changes.
struct SeenChange {
  std::string content;             // EditLayer::content
  std::vector<uint32_t> vertices;  // whose materials it changes
  VertexMaterials values;          // #vertices, with the layer; one where all are the same
  SeenId id;                       // of all vertices, with the layer

  size_t bytes() const;
};

class SeenHistory {
 public:
  explicit SeenHistory(VertexMaterials as_reconstructed);
  // Whether it has the changes of the scene's layers up to `last`. It may have those of later ones, too.
  bool reaches(const Scene& scene, int last) const { return common_layers(scene, last) == size_t(last + 1); }
  // One that has them, which goes on from the layers that the two have in common.
  SeenHistory through(const Device&, const Scene&, int last, int version) const;

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
    size_t next_ = 0;  // layer
  };

 private:
  size_t common_layers(const Scene&, int last) const;  // of the first ones

  std::shared_ptr<const VertexMaterials> rest_;
  SeenId id_;
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
