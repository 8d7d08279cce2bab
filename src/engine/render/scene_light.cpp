// SPDX-License-Identifier: Apache-2.0
#include "engine/render/scene_light.h"

#include <algorithm>
#include <cstring>

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
           same_bits(before_->look.albedo[hit], now_.look.albedo[hit]) &&
           same_material(material(*before_, hit), material(now_, hit));
  }

 private:
  static const Material& material(const LitHits& l, size_t hit) {
    return l.look.materials[l.look.material[hit]];
  }
  bool same_group(size_t a, size_t b) const {
    const int pose = now_.groups.keys[b].first;
    return before_->groups.keys[a].first == pose &&
           before_->lights[size_t(pose)] == now_.lights[size_t(pose)] &&
           same_colors(before_->mirrored[a], now_.mirrored[b]);
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

HitGroups SceneLight::groups_of(std::span<const Hit> hits, std::span<const int> layers) const {
  HitGroups groups;
  uint32_t last = 0;  // neighbours are mostly of one group
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
  const VertexColors& colors = out.mirrored[group];
  const std::span<const Vec3f> seen = colors ? std::span<const Vec3f>(*colors) : std::span<const Vec3f>();
  if (which.size() == hits.size() && triangles_.empty()) {  // all of them, as they are
    out.shading = lighting.shade(hits, out.look, seen);
    return;
  }
  std::vector<Hit> own;  // with the triangles of the pose
  own.reserve(which.size());
  Appearance look;
  look.materials = out.look.materials;
  for (const uint32_t i : which) {
    own.push_back(hits[i]);
    if (!triangles_.empty()) own.back().triangle = triangles_[pose][hits[i].triangle];
    look.albedo.push_back(out.look.albedo[i]);
    look.material.push_back(out.look.material[i]);
  }
  const Shading part = lighting.shade(own, look, seen);
  for (size_t j = 0; j < which.size(); ++j) {
    out.shading.diffuse[which[j]] = part.diffuse[j];
    out.shading.specular[which[j]] = part.specular[j];
  }
}

LitHits SceneLight::light_hits(std::span<const Hit> hits, Appearance look, const LitHits* before) const {
  LitHits out;
  out.shading = {std::vector<Vec3f>(hits.size()), std::vector<Vec3f>(hits.size())};
  out.look = std::move(look);
  out.lights = lights_;
  out.groups = groups_of(hits, out.look.layer);
  for (const auto& [pose, layer] : out.groups.keys) out.mirrored.push_back(colors_as_of(layer, pose));
  const Comparison comparison(before, out);
  std::vector<std::vector<uint32_t>> anew(out.groups.keys.size());  // hits by group
  for (uint32_t i = 0; i < hits.size(); ++i) {
    if (!comparison.same(i)) {
      anew[out.groups.of[i]].push_back(i);
      continue;
    }
    out.shading.diffuse[i] = before->shading.diffuse[i];
    out.shading.specular[i] = before->shading.specular[i];
    ++out.kept;
  }
  for (uint32_t group = 0; group < anew.size(); ++group)
    if (!anew[group].empty()) light_group(group, anew[group], hits, out);
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
