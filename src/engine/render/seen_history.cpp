// SPDX-License-Identifier: Apache-2.0
#include "engine/render/seen_history.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

#include "core/base/hash.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

// The share of a vertex in a SeenId.
SeenId share_of(uint32_t vertex, const Vec3f& albedo, const Material& m) {
  SeenId id{mixed(vertex + 1), mixed(~uint64_t(vertex))};
  for (const float x : {albedo.x, albedo.y, albedo.z, m.roughness, m.specular, m.metalness}) {
    id.a = mixed(id.a ^ std::bit_cast<uint32_t>(x));
    id.b = mixed(id.b + std::bit_cast<uint32_t>(x));
  }
  return id;
}

// Whether the layer was made while that shape version was the present one, or before.
bool was_on(const EditLayer& l, int version) {
  return l.shape_version <= version && !(l.reshape && max(l.shape_version, 0) + 1 > version);
}

bool changes_look(const EditLayer& l) {
  return l.albedo || l.erase || l.erase_material || l.tint || !l.material.empty() || l.reshape;
}

// Vertices that the last layer of the scene can change. hits: the vertices.
std::vector<uint32_t> reached(const Scene& scene, std::span<const Hit> hits) {
  const EditLayer& layer = scene.layers.back();
  std::vector<uint32_t> vertices;
  if (layer.everywhere || layer.reshape) {
    vertices.resize(hits.size());
    std::iota(vertices.begin(), vertices.end(), 0u);
    return vertices;
  }
  const std::vector<uint8_t> inside = inside_layer(scene, layer, hits);
  for (uint32_t v = 0; v < hits.size(); ++v)
    if (inside[v]) vertices.push_back(v);
  return vertices;
}

// Makes the changes of one layer after the other.
class Maker {
 public:
  // now: the materials before the first of them.
  Maker(const Device& device, const Scene& scene, int version, VertexMaterials now)
      : device_(device), below_(scene), version_(version), now_(std::move(now)) {
    below_.layers.clear();
    below_.residual = nullptr;
    if (!scene.shape_versions.empty()) below_.shape_versions.resize(size_t(version) + 1);
    hits_ =
        vertex_hits(scene.shape_versions.empty() ? scene.surface->mesh()
                                                 : scene.shape_versions[size_t(version)]->surface->mesh());
  }

  void skip(const EditLayer& layer) {
    if (was_on(layer, version_)) below_.layers.push_back(layer);
  }

  // before: the id without the layer.
  std::shared_ptr<const SeenChange> next(const EditLayer& layer, SeenId before) {
    auto change = std::make_shared<SeenChange>();
    change->content = layer.content;
    change->id = before;
    if (!was_on(layer, version_)) return change;
    below_.layers.push_back(layer);
    if (changes_look(layer)) look(*change);
    return change;
  }

 private:
  void look(SeenChange& change) {
    const std::vector<uint32_t> vertices = reached(below_, hits_);
    std::vector<Hit> some;
    for (const uint32_t v : vertices) some.push_back(hits_[v]);
    const Appearance look = appearance_at(device_, below_, some);
    for (size_t k = 0; k < vertices.size(); ++k) {
      const uint32_t v = vertices[k];
      if (same_bits(look.albedo[k], now_.albedo[v]) && look.material[k] == now_.material[v]) continue;
      const SeenId was = share_of(v, now_.albedo[v], now_.material[v]),
                   is = share_of(v, look.albedo[k], look.material[k]);
      change.id = {change.id.a + is.a - was.a, change.id.b + is.b - was.b};
      now_.albedo[v] = look.albedo[k];
      now_.material[v] = look.material[k];
      change.vertex_offset.push_back(v - uint32_t(change.vertex_offset.size()));
      change.albedo.push_back(look.albedo[k]);
      change.material.push_back(look.material[k]);
    }
    change.vertex_offset.shrink_to_fit();
    change.albedo.shrink_to_fit();
    change.material.shrink_to_fit();
  }

  const Device& device_;
  Scene below_;  // as of the last layer, reduced to what affects the shape version
  int version_;
  VertexMaterials now_;
  std::vector<Hit> hits_;  // the vertices
};

}  // namespace

size_t SeenChange::bytes() const {
  return sizeof(SeenChange) + content.size() + vertex_offset.bytes() + albedo.bytes() + material.bytes();
}

SeenHistory::SeenHistory(VertexMaterials as_reconstructed)
    : rest_(std::make_shared<const VertexMaterials>(std::move(as_reconstructed))),
      bytes_(rest_->albedo.size() * (sizeof(Vec3f) + sizeof(Material))) {
  for (uint32_t v = 0; v < rest_->albedo.size(); ++v) {
    const SeenId share = share_of(v, rest_->albedo[v], rest_->material[v]);
    id_ = {id_.a + share.a, id_.b + share.b};
  }
}

size_t SeenHistory::common_layers(const Scene& scene, int last) const {
  const size_t end = std::min(size_t(last + 1), changes_.size());
  size_t n = 0;
  while (n < end && !changes_[n]->content.empty() && changes_[n]->content == scene.layers[n].content) ++n;
  return n;
}

SeenHistory SeenHistory::through(const Device& device, const Scene& scene, int last, int version) const {
  const size_t wanted = size_t(last + 1), known = common_layers(scene, last);
  SeenHistory out = *this;
  if (known == wanted) return out;
  for (; out.changes_.size() > known; out.changes_.pop_back()) out.bytes_ -= out.changes_.back()->bytes();
  Maker maker(device, scene, version, Walk(out).after(int(known) - 1));
  for (size_t l = 0; l < known; ++l) maker.skip(scene.layers[l]);
  for (size_t l = known; l < wanted; ++l) {
    out.changes_.push_back(maker.next(scene.layers[l], out.id(int(l) - 1)));
    out.bytes_ += out.changes_.back()->bytes();
  }
  return out;
}

const VertexMaterials& SeenHistory::Walk::after(int layer) {
  for (; int(next_) <= layer; ++next_) {
    const SeenChange& change = *history_.changes_[next_];
    RunList<uint32_t>::Reader offset(change.vertex_offset);
    RunList<Vec3f>::Reader albedo(change.albedo);
    RunList<Material>::Reader material(change.material);
    for (uint32_t k = 0; k < change.vertex_offset.size(); ++k) {
      const uint32_t v = offset.next() + k;
      now_.albedo[v] = albedo.next();
      now_.material[v] = material.next();
    }
  }
  return now_;
}

}  // namespace cei3d
