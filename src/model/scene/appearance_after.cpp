// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include "core/base/hash.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

bool is_global(const EditLayer& l) { return l.everywhere || l.reshape; }

// Number of the first layers that both have.
size_t common_layers(const AppearanceKey& a, const AppearanceKey& b) {
  const size_t count = std::min(a.layers.size(), b.layers.size());
  size_t n = 0;
  while (n < count && a.layers[n] != 0 && a.layers[n] == b.layers[n]) ++n;
  return n;
}

bool same_base(const AppearanceKey& a, const AppearanceKey& b) {
  return a.albedo == b.albedo && a.material == b.material && a.shape == b.shape &&
         a.has_residual == b.has_residual;
}

// Hits in layers from `first` on, of this scene or of the one before.
std::vector<size_t> changed_hits(const Scene& scene, std::span<const Hit> hits, const Appearance& before,
                                 size_t first) {
  std::vector<uint8_t> changed(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) changed[i] = before.layer[i] >= int(first);
  for (size_t l = first; l < scene.layers.size(); ++l) {
    const std::vector<uint8_t> inside = inside_layer(scene, scene.layers[l], hits);
    for (size_t i = 0; i < hits.size(); ++i) changed[i] |= inside[i];
  }
  std::vector<size_t> which;
  for (size_t i = 0; i < hits.size(); ++i)
    if (changed[i]) which.push_back(i);
  return which;
}

template <class T>
void put(std::vector<T>& all, const std::vector<T>& some, std::span<const size_t> which) {
  for (size_t k = 0; k < which.size(); ++k) all[which[k]] = some[k];
}

}  // namespace

AppearanceKey::AppearanceKey(const Scene& scene)
    : albedo(scene.albedo),
      material(scene.material),
      shape(scene.shape_versions.empty() ? nullptr : scene.shape_versions.back()),
      has_residual(scene.residual != nullptr) {
  uint64_t chain = 1;
  for (const EditLayer& l : scene.layers) {
    chain = l.content.empty() ? 0 : mixed(chain + std::hash<std::string>()(l.content)) | 1;
    if (is_global(l)) last_global = int(layers.size());
    layers.push_back(chain);
  }
}

Appearance appearance_after(const Device& device, const Scene& scene, std::span<const Hit> hits,
                            const AppearanceKey& before_key, const Appearance& before) {
  const AppearanceKey key(scene);
  const size_t first = common_layers(before_key, key);
  if (!same_base(before_key, key) || before.layer.size() != hits.size() ||
      std::max(before_key.last_global, key.last_global) >= int(first))
    return appearance_at(device, scene, hits);
  const std::vector<size_t> which = changed_hits(scene, hits, before, first);
  std::vector<Hit> some;
  for (const size_t i : which) some.push_back(hits[i]);
  const Appearance now = appearance_at(device, scene, some);
  Appearance out = before;
  put(out.albedo, now.albedo, which);
  put(out.material, now.material, which);
  put(out.layer, now.layer, which);
  const auto put_shares = [&](std::vector<float>& all, const std::vector<float>& some, const auto& has) {
    const bool any = std::any_of(scene.layers.begin(), scene.layers.end(), has);
    all.resize(any ? hits.size() : 0, 0.0f);
    if (any) put(all, some, which);
  };
  put_shares(out.unlit, now.unlit, [](const EditLayer& l) { return l.unlit; });
  put_shares(out.covered, now.covered, [](const EditLayer& l) { return l.covers(); });
  if (!scene.residual) return out;
  put(out.photographed.albedo, now.photographed.albedo, which);
  put(out.photographed.material, now.photographed.material, which);
  put(out.photographed.in_place, now.photographed.in_place, which);
  return out;
}

}  // namespace cei3d
