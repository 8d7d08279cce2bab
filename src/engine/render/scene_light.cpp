// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace cei3d {
namespace {

// Extends them by the vertices that an edit has added.
VertexMaterials with_added(VertexMaterials m, const std::vector<Vec3f>& colors, const Material& material) {
  m.albedo.insert(m.albedo.end(), colors.begin() + std::ptrdiff_t(m.albedo.size()), colors.end());
  m.material.resize(m.albedo.size(), material);
  return m;
}

// #V, 1 for vertices that shape version k moved or added.
std::vector<uint8_t> changed_in(const ShapeVersions& versions, size_t k) {
  const Mesh &now = versions[k]->surface->mesh(), &before = versions[k - 1]->surface->mesh();
  std::vector<uint8_t> mask(now.positions.size(), 1);
  const auto same = [](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  for (size_t v = 0; v < before.positions.size(); ++v)
    mask[v] = !same(now.positions[v], before.positions[v]) || !same(now.normals[v], before.normals[v]);
  return mask;
}

// For each shape version, the ids in it of the present triangles.
std::vector<std::vector<uint32_t>> triangle_ids(const ShapeVersions& versions) {
  std::vector<std::vector<uint32_t>> ids(versions.size());
  const size_t n = versions.back()->surface->mesh().triangles.size();
  ids.back().resize(n);
  for (uint32_t t = 0; t < n; ++t) ids.back()[t] = t;
  for (size_t k = versions.size() - 1; k > 0; --k)
    for (const uint32_t t : ids[k]) ids[k - 1].push_back(versions[k]->before[t]);
  return ids;
}

size_t version_count(const Scene& scene) { return std::max<size_t>(scene.shape_versions.size(), 1); }

// Unlit albedo shows its own color in every light.
std::vector<ShadingTerms<float>> with_unlit(std::vector<ShadingTerms<float>> terms, const Appearance& look) {
  for (size_t i = 0; i < look.unlit.size(); ++i) {
    const float share = look.unlit[i], lit = 1 - share;
    if (share <= 0) continue;
    terms[i] = {terms[i].diffuse_gain * lit + Vec3f{share, share, share}, terms[i].specular_gain * lit,
                terms[i].specular_offset * lit};
  }
  return terms;
}

// Finds the hits whose light is unchanged since the last frame.
class Comparison {
 public:
  // before: null: none is.
  Comparison(const LitHits* before, const LitHits& now)
      : before_(before && before->groups.of.size() == now.groups.of.size() ? before : nullptr), now_(now) {
    if (!before_) return;
    for (size_t a = 0; a < before->groups.keys.size(); ++a)
      for (size_t b = 0; b < now.groups.keys.size(); ++b) same_groups_.push_back(same_group(a, b));
  }

  bool same(size_t hit) const {
    return before_ && same_groups_[before_->groups.of[hit] * now_.groups.keys.size() + now_.groups.of[hit]] &&
           before_->look.material[hit] == now_.look.material[hit];
  }

 private:
  bool same_group(size_t a, size_t b) const {
    const int version = now_.groups.keys[b].first;
    return before_->groups.keys[a].first == version &&
           before_->lights[size_t(version)] == now_.lights[size_t(version)] &&
           before_->seen[a] == now_.seen[b];
  }

  const LitHits* before_;
  const LitHits& now_;
  std::vector<uint8_t> same_groups_;  // [group before][group now]
};

}  // namespace

const std::shared_ptr<const Surface>& surface_of_version(const Scene& scene, size_t k) {
  return scene.shape_versions.empty() ? scene.surface : scene.shape_versions[k]->surface;
}

std::shared_ptr<const Transport> transport_of_version(const Scene& scene, size_t k) {
  return std::make_shared<const Transport>(
      surface_of_version(scene, k), k == 0 ? std::vector<uint8_t>() : changed_in(scene.shape_versions, k));
}

Transports scene_transports(const Scene& scene) {
  Transports out;
  for (size_t k = 0; k < version_count(scene); ++k) out.push_back(transport_of_version(scene, k));
  return out;
}

VertexMaterials rest_materials(const Device& device, const Scene& scene) {
  const auto& positions = surface_of_version(scene, 0)->mesh().positions;
  return {scene.albedo->eval3(device, positions), scene.material.at(device, positions)};
}

std::shared_ptr<const VersionLight> light_on_version(const Device& device, const Scene& scene, size_t k,
                                                     VertexLight vertices) {
  auto out = std::make_shared<VersionLight>();
  out->surface = surface_of_version(scene, k);
  out->vertices = std::move(vertices);
  out->lighting = std::make_shared<const Lighting>(device, out->surface, scene.light, out->vertices);
  return out;
}

std::shared_ptr<const VersionLight> light_on_version(const Device& device, const Scene& scene, size_t k,
                                                     const Transport& transport, const VersionLight* before) {
  if (!before)
    return light_on_version(device, scene, k,
                            vertex_light(transport, scene.light, rest_materials(device, scene)));
  return light_on_version(
      device, scene, k,
      vertex_light_after(
          before->vertices, transport, scene.light,
          with_added(before->vertices.made_of, scene.shape_versions[k]->colors, scene.material.mean())));
}

SceneLight::SceneLight(const Device& device, const Scene& scene, const Transports& transports)
    : SceneLight(device, scene, VersionLights(), nullptr) {
  for (size_t k = 0; k < version_count(scene); ++k)
    lights_.push_back(
        light_on_version(device, scene, k, *transports.at(k), k == 0 ? nullptr : lights_.back().get()));
}

SceneLight::SceneLight(const Device& device, const Scene& scene, VersionLights lights, SeenHistories* seen)
    : device_(device), scene_(scene), lights_(std::move(lights)), seen_(seen) {
  if (!scene.shape_versions.empty()) triangles_ = triangle_ids(scene.shape_versions);
  for (size_t l = 0; l < scene.layers.size(); ++l)
    if (scene.layers[l].everywhere) everywhere_ = int(l);
}

// The history of the materials of that shape version, up to that layer or a later one.
std::shared_ptr<const SeenHistory> SceneLight::history_of(int version, int last) const {
  const SeenHistoryKey key{surface_of_version(scene_, size_t(version)), scene_.albedo, scene_.material};
  auto history = seen_ ? seen_->find(key) : nullptr;
  if (history && history->reaches(scene_, last)) return history;
  if (!history) history = std::make_shared<const SeenHistory>(lights_[size_t(version)]->vertices.made_of);
  history = std::make_shared<const SeenHistory>(history->through(device_, scene_, last, version));
  return seen_ ? seen_->put(key, history, history->bytes()) : history;
}

SceneLight::Histories SceneLight::histories_of(const HitGroups& groups) const {
  std::map<int, int> last;  // layer, by shape version
  for (const auto& [version, layer] : groups.keys)
    last[version] = last.contains(version) ? max(last[version], layer) : layer;
  Histories out;
  for (const auto& [version, layer] : last) out.emplace(version, history_of(version, layer));
  return out;
}

HitGroups SceneLight::groups_of(std::span<const Hit> hits, std::span<const int> layers) const {
  HitGroups groups;
  uint32_t last = 0;  // neighboring hits mostly have the same group
  for (size_t i = 0; i < hits.size(); ++i) {
    const int version =
        scene_.shape_versions.empty() ? 0 : scene_.shape_versions.back()->shaped_in(hits[i].triangle);
    const std::pair<int, int> key{version, max(layers[i], everywhere_)};
    if (last >= groups.keys.size() || groups.keys[last] != key)
      last = uint32_t(std::find(groups.keys.begin(), groups.keys.end(), key) - groups.keys.begin());
    if (last == groups.keys.size()) groups.keys.push_back(key);
    groups.of.push_back(last);
  }
  return groups;
}

// which: indices of hits of that group.
void SceneLight::light_group(uint32_t group, std::span<const uint32_t> which, std::span<const Hit> hits,
                             const VertexMaterials& seen, LitHits& out) const {
  const auto version = size_t(out.groups.keys[group].first);
  const Lighting& lighting = *lights_[version]->lighting;
  if (which.size() == hits.size() && triangles_.empty()) {  // all hits, with unchanged triangles
    out.terms = lighting.terms({hits, out.look.material}, seen);
    return;
  }
  std::vector<Hit> own;  // with triangle ids of the shape version
  std::vector<Material> materials;
  own.reserve(which.size());
  materials.reserve(which.size());
  for (const uint32_t i : which) {
    own.push_back(hits[i]);
    if (!triangles_.empty()) own.back().triangle = triangles_[version][hits[i].triangle];
    materials.push_back(out.look.material[i]);
  }
  const std::vector<ShadingTerms<float>> part = lighting.terms({own, materials}, seen);
  for (size_t j = 0; j < which.size(); ++j) out.terms[which[j]] = part[j];
}

// changed: hits by group.
void SceneLight::light_groups(const Histories& histories, const std::vector<std::vector<uint32_t>>& changed,
                              std::span<const Hit> hits, LitHits& out) const {
  std::vector<uint32_t> order(changed.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto& keys = out.groups.keys;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  std::optional<SeenHistory::Walk> walk;
  int walked = -1;  // shape version
  for (const uint32_t group : order) {
    if (changed[group].empty()) continue;
    const auto [version, layer] = keys[group];
    const SeenHistory& history = *histories.at(version);
    if (out.seen[group] == history.id(-1)) {
      light_group(group, changed[group], hits, {}, out);
      continue;
    }
    if (walked != version) walk.emplace(history);
    walked = version;
    light_group(group, changed[group], hits, walk->after(layer), out);
  }
}

LitHits SceneLight::light_hits(std::span<const Hit> hits, Appearance look, const LitHits* before) const {
  LitHits out;
  out.terms.resize(hits.size());
  out.look = std::move(look);
  out.lights = lights_;
  out.groups = groups_of(hits, out.look.layer);
  const Histories histories = histories_of(out.groups);
  for (const auto& [version, layer] : out.groups.keys) out.seen.push_back(histories.at(version)->id(layer));
  const Comparison comparison(before, out);
  std::vector<std::vector<uint32_t>> changed(out.groups.keys.size());  // hits by group
  for (uint32_t i = 0; i < hits.size(); ++i) {
    if (!comparison.same(i)) {
      changed[out.groups.of[i]].push_back(i);
      continue;
    }
    out.terms[i] = before->terms[i];
    ++out.kept;
  }
  light_groups(histories, changed, hits, out);
  return out;
}

std::vector<ShadingTerms<float>> SceneLight::terms(std::span<const Hit> hits, const Appearance& look) const {
  return with_unlit(light_hits(hits, look, nullptr).terms, look);
}

Shading SceneLight::shade(std::span<const Hit> hits, const Appearance& look) const {
  return shading_of(terms(hits, look), look.albedo);
}

Shading LitHits::shading() const { return shading_of(with_unlit(terms, look), look.albedo); }

}  // namespace cei3d
