// SPDX-License-Identifier: Apache-2.0
#include "model/scene/appearance.h"

#include <algorithm>
#include <map>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

constexpr int kGrain = 16384;  // hits per chunk

// One contribution to a hit's albedo.
struct Op {
  enum class Kind { branch, base, added, tint } kind;
  int layer;
  uint32_t hit;
  float weight;    // of the color; the rest is the albedo below
  Vec3f position;  // of the hit in the shape version of the field that has the color
  Vec3f color;     // from the branch, the base or the added surface
};

// The layers that affect a hit.
struct Route {
  int layer = -1;                                 // topmost local layer; -1: none
  uint32_t material_begin = 0, material_end = 0;  // of the chunk's materials, the last one first
  bool base = true;                               // the lowest contribution is on top of the base's albedo
  bool untouched = true;                          // no layer contributes to the albedo

  bool same_material() const { return material_begin == material_end; }
};

struct Chunk {
  std::vector<Op> ops;         // contributions of each hit, topmost first
  std::vector<int> materials;  // layers that change the material of each hit, topmost first
};

// What encloses those of the hits that are in a shape version.
AxisBox box_in_version(const Scene& scene, std::span<const Hit> hits, int version) {
  AxisBox box;
  for (const Hit& h : hits)
    if (scene.shape_versions.empty() || scene.shape_versions.back()->born_in(h.triangle) <= version)
      box.add(in_version(scene.shape_versions, h, version).position);
  return box;
}

// The layers that can affect any of the hits, the topmost first.
std::vector<int> layers_near(const Scene& scene, std::span<const Hit> hits) {
  std::map<int, AxisBox> boxes;  // by shape version
  std::vector<int> near;
  for (int l = int(scene.layers.size()) - 1; l >= 0; --l) {
    const EditLayer& layer = scene.layers[size_t(l)];
    const int version = max(layer.shape_version, 0);
    if (!boxes.contains(version)) boxes[version] = box_in_version(scene, hits, version);
    if (layer.reshape || layer.may_meet(boxes[version])) near.push_back(l);
  }
  return near;
}

// Visits the layers of one hit, from the topmost down until nothing below can have an effect.
class Walk {
 public:
  Walk(const Scene& scene, const Hit& hit, uint32_t index, Chunk& chunk)
      : scene_(scene), hit_(hit), index_(index), chunk_(chunk) {
    if (scene.shape_versions.empty()) return;
    born_ = scene.shape_versions.back()->born_in(hit.triangle);
    shaped_ = scene.shape_versions.back()->shaped_in(hit.triangle);
  }

  // weights: of the layer.
  void visit(int l, const EditLayer& layer, LayerWeights& weights) {
    const int version = max(layer.shape_version, 0);
    if (layer.reshape) visit_change(l, version + 1);
    const bool colors = r_.base && (layer.albedo || layer.erase || layer.tint);
    const bool marks = r_.layer < 0 && !layer.everywhere;
    const bool changes = shows(layer.material, covered_) || layer.erase_material;
    if (!colors && !changes && !marks) return;
    // Surface that was added after this version lies in no earlier region. Only changes of material that
    // apply to the whole object reach it.
    const bool old = born_ <= version;
    if (!old && !layer.everywhere) return;
    const SurfacePoint p = old ? in_version(scene_.shape_versions, hit_, version) : SurfacePoint{};
    const float weight = weights.at(p.position, p.normal);
    if (weight <= 0) return;
    if (marks) r_.layer = l;
    if (changes && weight > kMaterialWeight) visit_material(l, layer);
    if (colors && old) visit_colors(l, layer, p, weight);
  }

  Route route() {
    r_.material_begin = uint32_t(chunk_.materials.size());
    chunk_.materials.insert(chunk_.materials.end(), materials_.begin(), materials_.end());
    r_.material_end = uint32_t(chunk_.materials.size());
    return r_;
  }

 private:
  void visit_material(int l, const EditLayer& layer) {
    if (shows(layer.material, covered_)) materials_.push_back(l);
    cover(covered_, layer.material);
    if (layer.erase_material) covered_ = {true, true, true};
  }

  void visit_colors(int l, const EditLayer& layer, const SurfacePoint& p, float weight) {
    if (layer.tint) add(Op::Kind::tint, l, weight, {}, {});
    if (layer.albedo) add(Op::Kind::branch, l, weight, p.position, {});
    if (layer.erase && born_ == 0)
      add(Op::Kind::base, l, weight, in_version(scene_.shape_versions, hit_, 0).position, {});
    if (layer.erase && born_ > 0) add(Op::Kind::added, l, weight, {}, own_color());
  }

  // For a layer that made this shape version.
  void visit_change(int l, int version) {
    if (r_.layer < 0 && shaped_ == version) r_.layer = l;
    if (r_.base && born_ == version) add(Op::Kind::added, l, 1, {}, own_color());
  }

  Vec3f own_color() const {
    const ShapeVersion& now = *scene_.shape_versions.back();
    const auto& t = now.surface->mesh().triangles[hit_.triangle];
    return at_corners(now.colors, t, hit_.b1, hit_.b2);
  }

  void add(Op::Kind kind, int l, float weight, Vec3f position, Vec3f color) {
    constexpr float kOpaque = 0.9995f;
    r_.untouched = false;
    chunk_.ops.push_back({kind, l, index_, weight < kOpaque ? weight : 1, position, color});
    if (weight >= kOpaque && kind != Op::Kind::tint) r_.base = false;
  }

  const Scene& scene_;
  const Hit& hit_;
  uint32_t index_;
  Chunk& chunk_;
  int born_ = 0, shaped_ = 0;
  MaterialValues covered_;  // by the layers that were visited
  std::vector<int> materials_;
  Route r_;
};

struct Routes {
  std::vector<Route> at;      // #hits
  std::vector<Chunk> chunks;  // of kGrain hits each

  Routes(const Scene& scene, std::span<const Hit> hits)
      : at(hits.size()), chunks((hits.size() + kGrain - 1) / kGrain) {
    if (scene.layers.empty()) return;
    parallel_ranges(int(hits.size()), kGrain, [&](int begin, int end) { route(scene, hits, begin, end); });
  }

 private:
  // One layer after the other, so that the data of each are read only once: a long session has more than fit
  // in memory.
  void route(const Scene& scene, std::span<const Hit> hits, int begin, int end) {
    std::vector<Walk> walks;
    for (int i = begin; i < end; ++i)
      walks.emplace_back(scene, hits[i], uint32_t(i), chunks[size_t(begin / kGrain)]);
    for (const int l : layers_near(scene, hits.subspan(size_t(begin), size_t(end - begin)))) {
      const EditLayer& layer = scene.layers[size_t(l)];
      LayerWeights weights(layer);
      for (Walk& walk : walks) walk.visit(l, layer, weights);
    }
    for (int i = begin; i < end; ++i) at[size_t(i)] = walks[size_t(i - begin)].route();
  }
};

// Fills in the colors of the fields; each field is evaluated only at hits that need it.
void eval_fields(const Device& device, const Scene& scene, Routes& routes) {
  std::vector<std::vector<Op*>> ops(scene.layers.size() + 1);  // by branch; the base last
  for (Chunk& chunk : routes.chunks)
    for (Op& op : chunk.ops)
      if (op.kind == Op::Kind::branch || op.kind == Op::Kind::base)
        ops[op.kind == Op::Kind::branch ? size_t(op.layer) : scene.layers.size()].push_back(&op);
  for (size_t l = 0; l < ops.size(); ++l) {
    if (ops[l].empty()) continue;
    std::vector<Vec3f> x;
    for (const Op* op : ops[l]) x.push_back(op->position);
    const std::vector<Vec3f> color =
        l < scene.layers.size() ? scene.layers[l].albedo->eval3(device, x) : scene.albedo->eval3(device, x);
    for (size_t i = 0; i < x.size(); ++i) ops[l][i]->color = color[i];
  }
}

std::vector<Vec3f> base_albedo(const Device& device, const Scene& scene, std::span<const Hit> hits,
                               const Routes& routes) {
  std::vector<Vec3f> albedo(hits.size()), x;
  std::vector<uint32_t> of;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (!routes.at[i].base) continue;
    x.push_back(in_version(scene.shape_versions, hits[i], 0).position);
    of.push_back(uint32_t(i));
  }
  const std::vector<Vec3f> color = scene.albedo->eval3(device, x);
  for (size_t k = 0; k < of.size(); ++k) albedo[of[k]] = color[k];
  return albedo;
}

// Combines the contributions into albedo, unlit and covered.
void put_colors(const Device& device, const Scene& scene, std::span<const Hit> hits, Routes& routes,
                Appearance& out) {
  eval_fields(device, scene, routes);
  out.albedo = base_albedo(device, scene, hits, routes);
  const auto& layers = scene.layers;
  if (std::any_of(layers.begin(), layers.end(), [](const EditLayer& l) { return l.unlit; }))
    out.unlit.assign(hits.size(), 0.0f);
  if (std::any_of(layers.begin(), layers.end(), [](const EditLayer& l) { return l.covers(); }))
    out.covered.assign(hits.size(), 0.0f);
  const auto mix = [](std::vector<float>& shares, uint32_t hit, float weight, bool own) {
    if (!shares.empty()) shares[hit] = shares[hit] * (1 - weight) + float(own) * weight;
  };
  for (const Chunk& chunk : routes.chunks)
    for (auto op = chunk.ops.rbegin(); op != chunk.ops.rend(); ++op) {
      Vec3f& a = out.albedo[op->hit];
      const Vec3f c = op->kind == Op::Kind::tint ? tinted(*scene.layers[op->layer].tint, a) : op->color;
      a = op->weight < 1 ? a * (1 - op->weight) + c * op->weight : c;
      if (op->kind == Op::Kind::tint) {
        const Tint& tint = *layers[op->layer].tint;
        if (!tint.keep_texture) mix(out.covered, op->hit, op->weight * tint.blend, true);
        continue;
      }
      const bool branch = op->kind == Op::Kind::branch;
      mix(out.unlit, op->hit, op->weight, branch && layers[op->layer].unlit);
      mix(out.covered, op->hit, op->weight, branch);
    }
}

// look: with the base's albedo where no layer covers it; material: the base's.
Photographed photographed(const Device& device, const Scene& scene, std::span<const Hit> hits,
                          const Routes& routes, const std::vector<Vec3f>& look,
                          const std::vector<Material>& material) {
  Photographed out{look, material, std::vector<uint8_t>(hits.size(), 1)};
  std::vector<Vec3f> x;
  std::vector<size_t> of;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (!scene.shape_versions.empty() && scene.shape_versions.back()->shaped_in(hits[i].triangle) > 0) {
      out.albedo[i] = {0, 0, 0};
      out.in_place[i] = 0;
    } else if (!routes.at[i].untouched) {
      x.push_back(in_version(scene.shape_versions, hits[i], 0).position);
      of.push_back(i);
    }
  }
  const std::vector<Vec3f> albedo = scene.albedo->eval3(device, x);
  for (size_t k = 0; k < of.size(); ++k) out.albedo[of[k]] = albedo[k];
  return out;
}

// Base materials. Surface that an edit added is outside the field's domain and gets the mean.
std::vector<Material> base_materials(const Device& device, const Scene& scene, std::span<const Hit> hits) {
  std::vector<Vec3f> points(hits.size(), Vec3f{0, 0, 0});
  std::vector<uint8_t> added(hits.size(), 0);
  for (size_t i = 0; i < hits.size(); ++i) {
    added[i] = !scene.shape_versions.empty() && scene.shape_versions.back()->born_in(hits[i].triangle) > 0;
    if (!added[i]) points[i] = in_version(scene.shape_versions, hits[i], 0).position;
  }
  std::vector<Material> materials = scene.material.at(device, points);
  for (size_t i = 0; i < hits.size(); ++i)
    if (added[i]) materials[i] = scene.material.mean();
  return materials;
}

// Applies the material changes of the layers to `below`, lowest first.
Material edited_material(const Scene& scene, const Route& r, const Chunk& chunk, Material below) {
  for (uint32_t k = r.material_end; k-- > r.material_begin;)
    below = changed(below, scene.layers[size_t(chunk.materials[k])].material);
  return below;
}

}  // namespace

Appearance appearance_at(const Device& device, const Scene& scene, std::span<const Hit> hits) {
  Routes routes(scene, hits);
  Appearance out;
  put_colors(device, scene, hits, routes, out);
  out.material = base_materials(device, scene, hits);
  if (scene.residual) out.photographed = photographed(device, scene, hits, routes, out.albedo, out.material);
  out.layer.resize(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const Route& r = routes.at[i];
    out.layer[i] = r.layer;
    if (!r.same_material())
      out.material[i] = edited_material(scene, r, routes.chunks[i / kGrain], out.material[i]);
  }
  return out;
}

std::vector<Hit> vertex_hits(const Mesh& mesh) {
  std::vector<Hit> hits(mesh.positions.size());
  for (size_t v = 0; v < hits.size(); ++v)
    hits[v] = {mesh.positions[v], mesh.normals[v], mesh.normals[v], 0, 0, 0};
  for (size_t t = mesh.triangles.size(); t-- > 0;)  // backwards: the first triangle of a vertex stays
    for (int c = 0; c < 3; ++c) {
      Hit& h = hits[mesh.triangles[t][c]];
      h.triangle = uint32_t(t);
      h.b1 = c == 1, h.b2 = c == 2;
    }
  return hits;
}

}  // namespace cei3d
