// SPDX-License-Identifier: Apache-2.0
#include "model/scene/dual_albedo.h"

#include "core/base/parallel.h"

namespace cei3d {
namespace {

struct Route {
  int layer = -1;   // topmost region
  int branch = -1;  // topmost region that has an albedo
};

Route route(std::span<const EditLayer> layers, const Hit& hit) {
  Route r;
  for (int l = int(layers.size()) - 1; l >= 0; --l) {
    if (!layers[l].region.contains(hit.position, hit.normal)) continue;
    if (r.layer < 0) r.layer = l;
    if (!layers[l].albedo) continue;
    r.branch = l;
    break;
  }
  return r;
}

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

}  // namespace

RoutedAlbedo routed_albedo(const Device& device, const Field& base, std::span<const EditLayer> layers,
                           std::span<const Hit> hits) {
  RoutedAlbedo out{std::vector<Vec3f>(hits.size()), std::vector<int>(hits.size(), -1)};
  std::vector<int> branch(hits.size(), -1);
  if (!layers.empty()) {
    parallel_ranges(int(hits.size()), 4096, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Route r = route(layers, hits[i]);
        out.layer[i] = r.layer;
        branch[i] = r.branch;
      }
    });
  }
  std::vector<std::vector<uint32_t>> chosen(layers.size() + 1);  // by branch; the base first
  for (size_t i = 0; i < hits.size(); ++i) chosen[branch[i] + 1].push_back(uint32_t(i));
  for (size_t b = 0; b < chosen.size(); ++b)
    eval_at(device, b ? *layers[b - 1].albedo : base, hits, chosen[b], out.albedo);
  return out;
}

}  // namespace cei3d
