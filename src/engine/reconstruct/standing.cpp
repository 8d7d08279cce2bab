// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/standing.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/render/render.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {

namespace {

constexpr size_t kSlab = 1 << 18;  // pixels at a time: tracing takes more memory than their hits do

// Empties the slab.
void add_hits(const Device& device, const Field& sdf, const Surface& surface, const PixelStore& pixels,
              std::vector<Pixel>& slab, ObjectHits& out) {
  std::vector<Ray> rays;
  rays.reserve(slab.size());
  for (const Pixel& p : slab) rays.push_back(pixels.cameras()[p.view].ray(p.x + 0.5, p.y + 0.5));
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, sdf, surface, rays, ray_of_hit);
  for (size_t i = 0; i < hits.size(); ++i) {
    const Pixel& p = slab[ray_of_hit[i]];
    const Camera& camera = pixels.cameras()[p.view];
    const auto channel = [&](int c) { return linear_from_srgb(float(p.srgba[c]) / 255); };
    out.hits.push_back(hits[i]);
    out.colors.push_back({channel(0), channel(1), channel(2)});
    out.clipped.push_back(uint8_t((p.srgba[0] == 255) | (p.srgba[1] == 255) << 1 | (p.srgba[2] == 255) << 2));
    out.views.push_back(p.view);
    out.footprints.push_back(length(hits[i].position - to_float(camera.center)) / float(camera.fx));
  }
  slab.clear();
}

}  // namespace

ObjectHits object_hits(const Device& device, const Field& sdf, const Surface& surface,
                       const PixelStore& pixels, size_t most, uint64_t subset) {
  size_t inner = 0;
  const auto inside = [](const Pixel& p) { return p.srgba[3] == 255; };
  for (const Pixel& p : pixels.pixels()) inner += inside(p);
  const double keep = std::min(1.0, double(most) / double(std::max<size_t>(inner, 1)));
  ObjectHits out;
  const auto reserve = [n = std::min(most, inner)](auto&... lists) { (lists.reserve(n), ...); };
  reserve(out.hits, out.colors, out.clipped, out.views, out.footprints);
  std::vector<Pixel> slab;
  size_t i = 0;
  for (const Pixel& p : pixels.pixels()) {
    if (!inside(p)) continue;
    if (keep == 1 || Rng(7, subset, i).uniform() < keep) slab.push_back(p);
    ++i;
    if (slab.size() == kSlab || i == inner) add_hits(device, sdf, surface, pixels, slab, out);
  }
  return out;
}

Standing stand(const Device& device, const Field& sdf, const Preset& preset, const PixelStore& pixels) {
  Standing s;
  s.surface = std::make_shared<const Surface>(extract_mesh(device, sdf, preset.meshing));
  s.hits = object_hits(device, sdf, *s.surface, pixels, preset.most_hits);
  if (s.hits.hits.empty()) fail("the reconstructed surface is not where the pictures show the object");
  return s;
}

}  // namespace cei3d
