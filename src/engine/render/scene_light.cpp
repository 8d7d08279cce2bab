// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <cstring>
#include <optional>

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

// Hits that one pose lights, with its own triangles, and what they look like.
struct Group {
  std::vector<uint32_t> index;
  std::vector<Hit> hits;
  Appearance look;
};

bool same_bits(const Vec3f& a, const Vec3f& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool same_material(const Material& a, const Material& b) {
  return a.roughness == b.roughness && a.specular == b.specular && a.metalness == b.metalness;
}

bool same_colors(const VertexColors& a, const VertexColors& b) {
  if (!a || !b) return a == b;
  return a == b ||
         (a->size() == b->size() && std::memcmp(a->data(), b->data(), a->size() * sizeof(Vec3f)) == 0);
}

size_t pose_count(const Scene& scene) { return std::max<size_t>(scene.poses.size(), 1); }

// What two ways to light the same hits have in common.
class Comparison {
 public:
  Comparison(const LitHits& before, const LitHits& now) : before_(before), now_(now) {}

  // Whether hit i, of these groups (pose and layer), is lit as it was.
  bool same(size_t i, std::pair<int, int> group_before, std::pair<int, int> group) {
    return same_bits(before_.look.albedo[i], now_.look.albedo[i]) &&
           same_material(before_.look.materials[before_.look.material[i]],
                         now_.look.materials[now_.look.material[i]]) &&
           same_groups(group_before, group);
  }

 private:
  bool same_groups(std::pair<int, int> a, std::pair<int, int> b) {
    const auto [it, is_new] = groups_.try_emplace({a, b}, false);
    if (is_new)
      it->second = a.first == b.first && before_.lights[size_t(a.first)] == now_.lights[size_t(b.first)] &&
                   same_colors(before_.mirrored.at(a), now_.mirrored.at(b));
    return it->second;
  }

  const LitHits &before_, &now_;
  std::map<std::pair<std::pair<int, int>, std::pair<int, int>>, bool> groups_;
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
  if (before) {
    std::vector<Vec3f> colors = before->vertices.base_color;
    const std::vector<Vec3f>& made = scene.poses[k]->colors;
    colors.insert(colors.end(), made.begin() + std::ptrdiff_t(colors.size()), made.end());
    out->vertices = vertex_light_after(before->vertices, transport, scene.light, colors);
  } else {
    out->vertices = vertex_light(transport, scene.light, base_colors(device, scene, *out->surface));
  }
  out->lighting =
      std::make_shared<const Lighting>(device, *out->surface, scene.light, scene.material, out->vertices);
  return out;
}

SceneLight::SceneLight(const Device& device, const Scene& scene, const Transports& transports)
    : SceneLight(device, scene, PoseLights(), nullptr) {
  for (size_t k = 0; k < pose_count(scene); ++k)
    lights_.push_back(
        light_on_pose(device, scene, k, *transports.at(k), k == 0 ? nullptr : lights_.back().get()));
}

SceneLight::SceneLight(const Device& device, const Scene& scene, PoseLights lights, VertexColorsCache* colors)
    : device_(device), scene_(scene), lights_(std::move(lights)), colors_(colors) {
  if (!scene.poses.empty()) triangles_ = triangle_ids(scene.poses);
  for (size_t l = 0; l < scene.layers.size(); ++l)
    if (scene.layers[l].everywhere) everywhere_ = int(l);
}

// Of the pose's vertices; null: as they were reconstructed.
VertexColors SceneLight::colors_as_of(int layer, int pose) const {
  VertexColorsKey key{surface_of_pose(scene_, size_t(pose)), scene_.albedo, {}};
  bool colored = false, stored = colors_;
  for (int l = 0; l <= layer; ++l) {
    const EditLayer& layer_l = scene_.layers[size_t(l)];
    if (!was_on(layer_l, pose)) continue;
    colored = colored || layer_l.albedo || layer_l.erase || layer_l.tint;
    stored = stored && !layer_l.content.empty();
    key.layers += layer_l.content + " ";
  }
  if (!colored) return nullptr;
  if (stored)
    if (const VertexColors kept = colors_->find(key)) return kept;
  const auto colors = std::make_shared<const std::vector<Vec3f>>(
      appearance_at(device_, as_of(scene_, layer, pose), vertex_hits(key.surface->mesh())).albedo);
  if (stored) colors_->put(std::move(key), colors, colors->size() * sizeof(Vec3f));
  return colors;
}

LitHits SceneLight::light_hits(std::span<const Hit> hits, const Appearance& look,
                               const LitHits* before) const {
  LitHits out{
      {std::vector<Vec3f>(hits.size()), std::vector<Vec3f>(hits.size())}, look, lights_, {}, everywhere_};
  for (size_t i = 0; i < hits.size(); ++i) out.mirrored.try_emplace(group_of(hits[i], look.layer[i]));
  for (auto& [group, colors] : out.mirrored) colors = colors_as_of(group.second, group.first);
  std::optional<Comparison> comparison;
  if (before && before->look.albedo.size() == hits.size()) comparison.emplace(*before, out);
  std::map<std::pair<int, int>, Group> groups;  // what is lit anew
  for (uint32_t i = 0; i < hits.size(); ++i) {
    const std::pair<int, int> key = group_of(hits[i], look.layer[i]);
    if (comparison && comparison->same(i, {key.first, max(before->look.layer[i], before->everywhere)}, key)) {
      out.shading.diffuse[i] = before->shading.diffuse[i];
      out.shading.specular[i] = before->shading.specular[i];
      ++out.kept;
      continue;
    }
    Group& g = groups[key];
    g.index.push_back(i);
    g.hits.push_back(hits[i]);
    if (!triangles_.empty()) g.hits.back().triangle = triangles_[size_t(key.first)][hits[i].triangle];
    g.look.albedo.push_back(look.albedo[i]);
    g.look.material.push_back(look.material[i]);
  }
  for (auto& [key, group] : groups) {
    const VertexColors& seen = out.mirrored.at(key);
    group.look.materials = look.materials;
    const Shading part = lights_[size_t(key.first)]->lighting->shade(
        group.hits, group.look, seen ? std::span<const Vec3f>(*seen) : std::span<const Vec3f>());
    for (size_t j = 0; j < group.index.size(); ++j) {
      out.shading.diffuse[group.index[j]] = part.diffuse[j];
      out.shading.specular[group.index[j]] = part.specular[j];
    }
  }
  return out;
}

Shading SceneLight::shade(std::span<const Hit> hits, const Appearance& look) const {
  return with_unlit(light_hits(hits, look, nullptr).shading, look);
}

Shading with_unlit(Shading lit, const Appearance& look) {
  for (size_t i = 0; i < look.unlit.size(); ++i) {
    const float share = look.unlit[i];
    if (share <= 0) continue;
    lit.diffuse[i] = lit.diffuse[i] * (1 - share) + look.albedo[i] * share;
    lit.specular[i] = lit.specular[i] * (1 - share);
  }
  return lit;
}

}  // namespace cei3d
