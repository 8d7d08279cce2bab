// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <map>
#include <utility>

namespace cei3d {
namespace {

std::vector<Vec3f> base_colors(const Device& device, const Scene& scene, const Surface& rest) {
  const auto& positions = rest.mesh().positions;
  std::vector<float> values(positions.size() * 3);
  scene.albedo->eval(device, positions, values);
  std::vector<Vec3f> colors(positions.size());
  for (size_t v = 0; v < colors.size(); ++v)
    colors[v] = {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
  return colors;
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

// What shows its own colour in every light.
Shading with_unlit(Shading lit, const Appearance& look) {
  for (size_t i = 0; i < look.unlit.size(); ++i) {
    const float share = look.unlit[i];
    if (share <= 0) continue;
    lit.diffuse[i] = lit.diffuse[i] * (1 - share) + look.albedo[i] * share;
    lit.specular[i] = lit.specular[i] * (1 - share);
  }
  return lit;
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

// Hits that one pose lights, with its own triangles, and what they look like.
struct Group {
  std::vector<uint32_t> index;
  std::vector<Hit> hits;
  Appearance look;
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
  const Surface& rest = poses.empty() ? *scene_.surface : *poses.front()->surface;
  std::vector<Vec3f> colors = base_colors(device, scene, rest);
  VertexLight light = vertex_light(*transports.at(0), scene.light, colors);
  lights_.push_back(std::make_shared<const Lighting>(device, rest, scene.light, scene.material, light));
  for (size_t k = 1; k < poses.size(); ++k) {
    const Pose& pose = *poses[k];
    colors.insert(colors.end(), pose.colors.begin() + colors.size(), pose.colors.end());
    light = vertex_light_after(std::move(light), *transports.at(k), scene.light, colors);
    lights_.push_back(
        std::make_shared<const Lighting>(device, *pose.surface, scene.light, scene.material, light));
  }
  if (!poses.empty()) triangles_ = triangle_ids(poses);
  for (size_t l = 0; l < scene.layers.size(); ++l)
    if (scene.layers[l].everywhere) everywhere_ = int(l);
}

// Of the pose's vertices; empty: as they were reconstructed.
std::vector<Vec3f> SceneLight::colors_as_of(int layer, int pose) const {
  if (layer < 0) return {};
  const Scene then = as_of(scene_, layer, pose);
  const bool colored = std::any_of(then.layers.begin(), then.layers.end(),
                                   [](const EditLayer& l) { return l.albedo || l.erase || l.tint; });
  if (!colored) return {};
  const Surface& surface = scene_.poses.empty() ? *scene_.surface : *scene_.poses[size_t(pose)]->surface;
  return appearance_at(device_, then, vertex_hits(surface.mesh())).albedo;
}

Shading SceneLight::shade(std::span<const Hit> hits, const Appearance& look) const {
  std::map<std::pair<int, int>, Group> groups;  // by pose and by the last layer that has to do with them
  for (uint32_t i = 0; i < hits.size(); ++i) {
    const int pose = scene_.poses.empty() ? 0 : scene_.poses.back()->shaped_in(hits[i].triangle);
    Group& g = groups[{pose, max(look.layer[i], everywhere_)}];
    g.index.push_back(i);
    g.hits.push_back(hits[i]);
    if (!triangles_.empty()) g.hits.back().triangle = triangles_[pose][hits[i].triangle];
    g.look.albedo.push_back(look.albedo[i]);
    g.look.material.push_back(look.material[i]);
  }
  Shading out{std::vector<Vec3f>(hits.size()), std::vector<Vec3f>(hits.size())};
  for (auto& [key, group] : groups) {
    const auto [pose, layer] = key;
    group.look.materials = look.materials;
    const Shading part = lights_[pose]->shade(group.hits, group.look, colors_as_of(layer, pose));
    for (size_t j = 0; j < group.index.size(); ++j) {
      out.diffuse[group.index[j]] = part.diffuse[j];
      out.specular[group.index[j]] = part.specular[j];
    }
  }
  return with_unlit(std::move(out), look);
}

}  // namespace cei3d
