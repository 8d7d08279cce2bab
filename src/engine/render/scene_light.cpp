// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

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

// The hits that one pose lights, with its own triangles, and what they look like.
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
    : poses_(scene.poses), surface_(scene.surface) {
  const Surface& rest = poses_.empty() ? *surface_ : *poses_.front()->surface;
  std::vector<Vec3f> colors = base_colors(device, scene, rest);
  VertexLight light = vertex_light(*transports.at(0), scene.light, colors);
  lights_.push_back(std::make_shared<const Lighting>(device, rest, scene.light, scene.material, light));
  for (size_t k = 1; k < poses_.size(); ++k) {
    const Pose& pose = *poses_[k];
    colors.insert(colors.end(), pose.colors.begin() + colors.size(), pose.colors.end());
    light = vertex_light_after(std::move(light), *transports.at(k), scene.light, colors);
    lights_.push_back(
        std::make_shared<const Lighting>(device, *pose.surface, scene.light, scene.material, light));
  }
  if (!poses_.empty()) triangles_ = triangle_ids(poses_);
}

Shading SceneLight::shade(std::span<const Hit> hits, const Appearance& look) const {
  if (poses_.empty()) return with_unlit(lights_[0]->shade(hits, look), look);
  std::vector<Group> groups(poses_.size());
  for (uint32_t i = 0; i < hits.size(); ++i) {
    const int pose = poses_.back()->shaped_in(hits[i].triangle);
    Group& g = groups[pose];
    g.index.push_back(i);
    g.hits.push_back(hits[i]);
    g.hits.back().triangle = triangles_[pose][hits[i].triangle];
    g.look.albedo.push_back(look.albedo[i]);
    g.look.material.push_back(look.material[i]);
  }
  Shading out{std::vector<Vec3f>(hits.size()), std::vector<Vec3f>(hits.size())};
  for (size_t k = 0; k < groups.size(); ++k) {
    groups[k].look.materials = look.materials;
    const Shading part = lights_[k]->shade(groups[k].hits, groups[k].look);
    for (size_t j = 0; j < groups[k].index.size(); ++j) {
      out.diffuse[groups[k].index[j]] = part.diffuse[j];
      out.specular[groups[k].index[j]] = part.specular[j];
    }
  }
  return with_unlit(std::move(out), look);
}

}  // namespace cei3d
