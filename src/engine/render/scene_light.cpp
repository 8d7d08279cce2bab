// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <cstring>

namespace cei3d {
namespace {

// As reconstructed, in the first shape.
VertexMaterials rest_materials(const Device& device, const Scene& scene, const Surface& rest) {
  const auto& positions = rest.mesh().positions;
  return {scene.albedo->eval3(device, positions), scene.material.at(device, positions)};
}

// With the vertices that an edit has added.
VertexMaterials with_added(VertexMaterials m, const std::vector<Vec3f>& colors, const Material& material) {
  m.albedo.insert(m.albedo.end(), colors.begin() + std::ptrdiff_t(m.albedo.size()), colors.end());
  m.material.resize(m.albedo.size(), material);
  return m;
}

// Vertices that a pose moved or made. #V of the pose.
std::vector<uint8_t> changed_in(const Poses& poses, size_t k) {
  const Mesh &now = poses[k]->surface->mesh(), &before = poses[k - 1]->surface->mesh();
  std::vector<uint8_t> mask(now.positions.size(), 1);
  const auto same = [](Vec3f a, Vec3f b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  for (size_t v = 0; v < before.positions.size(); ++v)
    mask[v] = !same(now.positions[v], before.positions[v]) || !same(now.normals[v], before.normals[v]);
  return mask;
}

// For each pose, which of its triangles the present one was.
std::vector<std::vector<uint32_t>> triangle_ids(const Poses& poses) {
  std::vector<std::vector<uint32_t>> ids(poses.size());
  const size_t n = poses.back()->surface->mesh().triangles.size();
  ids.back().resize(n);
  for (uint32_t t = 0; t < n; ++t) ids.back()[t] = t;
  for (size_t k = poses.size() - 1; k > 0; --k)
    for (const uint32_t t : ids[k]) ids[k - 1].push_back(poses[k]->before[t]);
  return ids;
}

// Whether the layer was there when that pose of the object was the present one.
bool was_on(const EditLayer& l, int pose) {
  return l.pose <= pose && !(l.reshape && max(l.pose, 0) + 1 > pose);
}

// The scene as it was when that layer had been put on, as far as it has to do with that pose.
Scene as_of(Scene scene, int layer, int pose) {
  scene.layers.resize(size_t(layer) + 1);
  std::erase_if(scene.layers, [&](const EditLayer& l) { return !was_on(l, pose); });
  if (!scene.poses.empty()) scene.poses.resize(size_t(pose) + 1);
  return scene;
}

bool same_bits(const Vec3f& a, const Vec3f& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool same_materials(const SeenMaterials& a, const SeenMaterials& b) {
  if (a == b || !a || !b) return a == b;
  return std::equal(a->albedo.begin(), a->albedo.end(), b->albedo.begin(), b->albedo.end(), same_bits) &&
         a->material == b->material;
}

size_t pose_count(const Scene& scene) { return std::max<size_t>(scene.poses.size(), 1); }

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

// Which hits are lit as they were.
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
    const int pose = now_.groups.keys[b].first;
    return before_->groups.keys[a].first == pose &&
           before_->lights[size_t(pose)] == now_.lights[size_t(pose)] &&
           same_materials(before_->seen[a], now_.seen[b]);
  }

  const LitHits* before_;
  const LitHits& now_;
  std::vector<uint8_t> same_groups_;  // [group before][group now]
};

}  // namespace

const std::shared_ptr<const Surface>& surface_of_pose(const Scene& scene, size_t k) {
  return scene.poses.empty() ? scene.surface : scene.poses[k]->surface;
}

std::shared_ptr<const Transport> transport_of_pose(const Scene& scene, size_t k) {
  return std::make_shared<const Transport>(surface_of_pose(scene, k),
                                           k == 0 ? std::vector<uint8_t>() : changed_in(scene.poses, k));
}

Transports scene_transports(const Scene& scene) {
  Transports out;
  for (size_t k = 0; k < pose_count(scene); ++k) out.push_back(transport_of_pose(scene, k));
  return out;
}

std::shared_ptr<const PoseLight> light_on_pose(const Device& device, const Scene& scene, size_t k,
                                               const Transport& transport, const PoseLight* before) {
  auto out = std::make_shared<PoseLight>();
  out->surface = surface_of_pose(scene, k);
  out->vertices = before ? vertex_light_after(before->vertices, transport, scene.light,
                                              with_added(before->vertices.made_of, scene.poses[k]->colors,
                                                         scene.material.mean()))
                         : vertex_light(transport, scene.light, rest_materials(device, scene, *out->surface));
  out->lighting = std::make_shared<const Lighting>(device, out->surface, scene.light, out->vertices);
  return out;
}

SceneLight::SceneLight(const Device& device, const Scene& scene, const Transports& transports)
    : SceneLight(device, scene, PoseLights(), nullptr) {
  for (size_t k = 0; k < pose_count(scene); ++k)
    lights_.push_back(
        light_on_pose(device, scene, k, *transports.at(k), k == 0 ? nullptr : lights_.back().get()));
}

SceneLight::SceneLight(const Device& device, const Scene& scene, PoseLights lights, SeenMaterialsCache* seen)
    : device_(device), scene_(scene), lights_(std::move(lights)), seen_(seen) {
  if (!scene.poses.empty()) triangles_ = triangle_ids(scene.poses);
  for (size_t l = 0; l < scene.layers.size(); ++l)
    if (scene.layers[l].everywhere) everywhere_ = int(l);
}

// Of the vertices of that pose; null: as they were reconstructed.
SeenMaterials SceneLight::materials_as_of(int layer, int pose) const {
  SeenMaterialsKey key{surface_of_pose(scene_, size_t(pose)), scene_.albedo, scene_.material, {}};
  bool changed = false, stored = seen_;
  for (int l = 0; l <= layer; ++l) {
    const EditLayer& layer_l = scene_.layers[size_t(l)];
    if (!was_on(layer_l, pose)) continue;
    changed = changed || layer_l.albedo || layer_l.erase || layer_l.erase_material || layer_l.tint ||
              !layer_l.material.empty();
    stored = stored && !layer_l.content.empty();
    key.layers += layer_l.content + " ";
  }
  if (!changed) return nullptr;
  if (stored)
    if (const SeenMaterials kept = seen_->find(key)) return kept;
  Appearance look = appearance_at(device_, as_of(scene_, layer, pose), vertex_hits(key.surface->mesh()));
  const auto made_of = std::make_shared<const VertexMaterials>(
      VertexMaterials{std::move(look.albedo), std::move(look.material)});
  if (stored)
    seen_->put(std::move(key), made_of, made_of->albedo.size() * (sizeof(Vec3f) + sizeof(Material)));
  return made_of;
}

HitGroups SceneLight::groups_of(std::span<const Hit> hits, std::span<const int> layers) const {
  HitGroups groups;
  uint32_t last = 0;  // neighbors are mostly of one group
  for (size_t i = 0; i < hits.size(); ++i) {
    const int pose = scene_.poses.empty() ? 0 : scene_.poses.back()->shaped_in(hits[i].triangle);
    const std::pair<int, int> key{pose, max(layers[i], everywhere_)};
    if (last >= groups.keys.size() || groups.keys[last] != key)
      last = uint32_t(std::find(groups.keys.begin(), groups.keys.end(), key) - groups.keys.begin());
    if (last == groups.keys.size()) groups.keys.push_back(key);
    groups.of.push_back(last);
  }
  return groups;
}

// which: indices of hits of that group.
void SceneLight::light_group(uint32_t group, std::span<const uint32_t> which, std::span<const Hit> hits,
                             LitHits& out) const {
  const auto pose = size_t(out.groups.keys[group].first);
  const Lighting& lighting = *lights_[pose]->lighting;
  const VertexMaterials none, &seen = out.seen[group] ? *out.seen[group] : none;
  if (which.size() == hits.size() && triangles_.empty()) {  // all of them, as they are
    out.terms = lighting.terms({hits, out.look.material}, seen);
    return;
  }
  std::vector<Hit> own;  // with the triangles of the pose
  std::vector<Material> materials;
  own.reserve(which.size());
  materials.reserve(which.size());
  for (const uint32_t i : which) {
    own.push_back(hits[i]);
    if (!triangles_.empty()) own.back().triangle = triangles_[pose][hits[i].triangle];
    materials.push_back(out.look.material[i]);
  }
  const std::vector<ShadingTerms<float>> part = lighting.terms({own, materials}, seen);
  for (size_t j = 0; j < which.size(); ++j) out.terms[which[j]] = part[j];
}

LitHits SceneLight::light_hits(std::span<const Hit> hits, Appearance look, const LitHits* before) const {
  LitHits out;
  out.terms.resize(hits.size());
  out.look = std::move(look);
  out.lights = lights_;
  out.groups = groups_of(hits, out.look.layer);
  for (const auto& [pose, layer] : out.groups.keys) out.seen.push_back(materials_as_of(layer, pose));
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
  for (uint32_t group = 0; group < changed.size(); ++group)
    if (!changed[group].empty()) light_group(group, changed[group], hits, out);
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
