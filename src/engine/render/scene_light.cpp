// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <map>
#include <utility>

namespace cei3d {
namespace {

// As reconstructed, in the first shape.
VertexMaterials rest_materials(const Device& device, const Scene& scene, const Surface& rest) {
  const auto& positions = rest.mesh().positions;
  return {scene.albedo->eval3(device, positions), scene.material.at(positions)};
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

// Unlit albedo shows its own color in every light.
void add_unlit(const Appearance& look, std::vector<ShadingTerms<float>>& terms) {
  for (size_t i = 0; i < look.unlit.size(); ++i) {
    const float share = look.unlit[i], lit = 1 - share;
    if (share <= 0) continue;
    terms[i] = {terms[i].diffuse_gain * lit + Vec3f{share, share, share}, terms[i].specular_gain * lit,
                terms[i].specular_offset * lit};
  }
}

// The scene as it was when that layer had been put on, as far as it has to do with that pose.
Scene as_of(Scene scene, int layer, int pose) {
  scene.layers.resize(size_t(layer) + 1);
  std::erase_if(scene.layers, [&](const EditLayer& l) {
    return l.pose > pose || (l.reshape && max(l.pose, 0) + 1 > pose);
  });
  if (!scene.poses.empty()) scene.poses.resize(size_t(pose) + 1);
  return scene;
}

// Hits that one shape lights, with that shape's triangles.
struct Group {
  std::vector<uint32_t> index;  // in the whole batch
  std::vector<Hit> hits;
  std::vector<Material> materials;
};

}  // namespace

std::vector<std::shared_ptr<const Transport>> scene_transports(const Scene& scene) {
  const Surface& rest = scene.poses.empty() ? *scene.surface : *scene.poses.front()->surface;
  std::vector<std::shared_ptr<const Transport>> out{std::make_shared<const Transport>(rest)};
  for (size_t k = 1; k < scene.poses.size(); ++k)
    out.push_back(std::make_shared<const Transport>(*scene.poses[k]->surface, changed_in(scene.poses, k)));
  return out;
}

SceneLight::SceneLight(const Device& device, const Scene& scene,
                       const std::vector<std::shared_ptr<const Transport>>& transports)
    : device_(device), scene_(scene) {
  const Poses& poses = scene_.poses;
  const std::shared_ptr<const Surface> rest = poses.empty() ? scene_.surface : poses.front()->surface;
  VertexMaterials made_of = rest_materials(device, scene, *rest);
  VertexLight light = vertex_light(*transports.at(0), scene.light, made_of);
  lights_.push_back(std::make_shared<const Lighting>(device, rest, scene.light, light));
  for (size_t k = 1; k < poses.size(); ++k) {
    made_of = with_added(std::move(made_of), poses[k]->colors, scene.material.mean());
    light = vertex_light_after(std::move(light), *transports.at(k), scene.light, made_of);
    lights_.push_back(std::make_shared<const Lighting>(device, poses[k]->surface, scene.light, light));
  }
  if (!poses.empty()) triangles_ = triangle_ids(poses);
  for (size_t l = 0; l < scene.layers.size(); ++l)
    if (scene.layers[l].everywhere) everywhere_ = int(l);
}

// Of the vertices of that pose; empty: as they were reconstructed.
VertexMaterials SceneLight::materials_as_of(int layer, int pose) const {
  if (layer < 0) return {};
  const Scene then = as_of(scene_, layer, pose);
  const bool changed = std::any_of(then.layers.begin(), then.layers.end(), [](const EditLayer& l) {
    return l.albedo || l.erase || l.tint || !l.material.empty();
  });
  if (!changed) return {};
  const Surface& surface = scene_.poses.empty() ? *scene_.surface : *scene_.poses[size_t(pose)]->surface;
  Appearance look = appearance_at(device_, then, vertex_hits(surface.mesh()));
  return {std::move(look.albedo), std::move(look.material)};
}

std::vector<ShadingTerms<float>> SceneLight::terms(std::span<const Hit> hits, const Appearance& look) const {
  std::map<std::pair<int, int>, Group> groups;  // by shape and by the last layer that applies to them
  for (uint32_t i = 0; i < hits.size(); ++i) {
    const int pose = scene_.poses.empty() ? 0 : scene_.poses.back()->shaped_in(hits[i].triangle);
    Group& g = groups[{pose, max(look.layer[i], everywhere_)}];
    g.index.push_back(i);
    g.hits.push_back(hits[i]);
    if (!triangles_.empty()) g.hits.back().triangle = triangles_[pose][hits[i].triangle];
    g.materials.push_back(look.material[i]);
  }
  std::vector<ShadingTerms<float>> out(hits.size());
  for (const auto& [key, group] : groups) {
    const auto [pose, layer] = key;
    const std::vector<ShadingTerms<float>> part =
        lights_[pose]->terms({group.hits, group.materials}, materials_as_of(layer, pose));
    for (size_t j = 0; j < group.index.size(); ++j) out[group.index[j]] = part[j];
  }
  add_unlit(look, out);
  return out;
}

Shading SceneLight::shade(std::span<const Hit> hits, const Appearance& look) const {
  return shading_of(terms(hits, look), look.albedo);
}

}  // namespace cei3d
