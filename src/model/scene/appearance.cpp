// SPDX-License-Identifier: Apache-2.0
#include "model/scene/appearance.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

constexpr int kGrain = 4096;  // hits a chunk

// What the layers say about a hit.
struct Route {
  int layer = -1;           // topmost that has a region of its own
  int branch = -1;          // topmost that has an albedo; -1: the base
  MaterialChange material;  // of all layers together
  uint32_t tint_begin = 0,
           tint_end = 0;  // of the chunk's list of tints: those above the branch, topmost first
};

struct Chunk {
  std::vector<const Tint*> tints;
};

void put_below(MaterialChange& top, const MaterialChange& below) {
  if (!top.roughness) top.roughness = below.roughness;
  if (!top.specular) top.specular = below.specular;
  if (!top.metalness) top.metalness = below.metalness;
}

bool is_whole(const MaterialChange& c) { return c.roughness && c.specular && c.metalness; }

// From the topmost layer down, and no further than anything can still change.
Route route(std::span<const EditLayer> layers, const Hit& hit, Chunk& chunk) {
  Route r;
  r.tint_begin = uint32_t(chunk.tints.size());
  for (int l = int(layers.size()) - 1; l >= 0; --l) {
    const EditLayer& layer = layers[l];
    const bool colours = r.branch < 0 && (layer.albedo || layer.tint),
               marks = r.layer < 0 && !layer.everywhere;
    const bool changes = !layer.material.empty() && !is_whole(r.material);
    if (!colours && !changes && !marks) continue;
    if (!layer.contains(hit.position, hit.normal)) continue;
    if (marks) r.layer = l;
    if (changes) put_below(r.material, layer.material);
    if (!colours) continue;
    if (layer.tint) chunk.tints.push_back(&*layer.tint);
    if (layer.albedo) r.branch = l;
  }
  r.tint_end = uint32_t(chunk.tints.size());
  return r;
}

struct Routes {
  std::vector<Route> at;      // #hits
  std::vector<Chunk> chunks;  // of kGrain hits each

  Routes(std::span<const EditLayer> layers, std::span<const Hit> hits)
      : at(hits.size()), chunks((hits.size() + kGrain - 1) / kGrain) {
    if (layers.empty()) return;
    parallel_ranges(int(hits.size()), kGrain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) at[i] = route(layers, hits[i], chunks[begin / kGrain]);
    });
  }
};

// Evaluates the field at the chosen hits only.
void eval_at(const Device& device, const Field& field, std::span<const Hit> hits,
             std::span<const uint32_t> chosen, std::vector<Vec3f>& albedo) {
  if (chosen.empty()) return;
  std::vector<Vec3f> x(chosen.size());
  for (size_t i = 0; i < x.size(); ++i) x[i] = hits[chosen[i]].position;
  std::vector<float> value(3 * x.size());
  field.eval(device, x, value);
  for (size_t i = 0; i < x.size(); ++i)
    albedo[chosen[i]] = {value[3 * i], value[3 * i + 1], value[3 * i + 2]};
}

std::vector<Vec3f> albedo_at(const Device& device, const Scene& scene, std::span<const Hit> hits,
                             const Routes& routes) {
  std::vector<Vec3f> albedo(hits.size());
  std::vector<std::vector<uint32_t>> chosen(scene.layers.size() + 1);  // by branch; the base first
  for (size_t i = 0; i < hits.size(); ++i) chosen[routes.at[i].branch + 1].push_back(uint32_t(i));
  for (size_t b = 0; b < chosen.size(); ++b)
    eval_at(device, b ? *scene.layers[b - 1].albedo : *scene.albedo, hits, chosen[b], albedo);
  for (size_t i = 0; i < hits.size(); ++i) {
    const Route& r = routes.at[i];
    const auto& tints = routes.chunks[i / kGrain].tints;
    for (uint32_t t = r.tint_end; t > r.tint_begin; --t) albedo[i] = tinted(*tints[t - 1], albedo[i]);
  }
  return albedo;
}

// The list of distinct materials, in the order of their first hit.
class Materials {
 public:
  explicit Materials(const Material& own) { index_of(own); }
  uint32_t index_of(const Material& m) {
    const auto [it, is_new] =
        index_.emplace(std::tuple(m.roughness, m.specular, m.metalness), uint32_t(list.size()));
    if (is_new) list.push_back(m);
    return it->second;
  }
  std::vector<Material> list;

 private:
  std::map<std::tuple<float, float, float>, uint32_t> index_;
};

}  // namespace

Appearance appearance_at(const Device& device, const Scene& scene, std::span<const Hit> hits) {
  const Routes routes(scene.layers, hits);
  Appearance out;
  out.albedo = albedo_at(device, scene, hits, routes);
  out.material.assign(hits.size(), 0);
  out.layer.resize(hits.size());
  Materials materials(scene.material);
  for (size_t i = 0; i < hits.size(); ++i) {
    const Route& r = routes.at[i];
    out.layer[i] = r.layer;
    if (!r.material.empty()) out.material[i] = materials.index_of(changed(scene.material, r.material));
  }
  out.materials = std::move(materials.list);
  return out;
}

}  // namespace cei3d
