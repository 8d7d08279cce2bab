// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/standing.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/rng.h"
#include "engine/render/render.h"
#include "model/geometry/surface_nets.h"

namespace cei3d {

ObjectHits object_hits(const Device& device, const Field& sdf, const Surface& surface,
                       const PixelStore& pixels, size_t most, uint64_t subset) {
  std::vector<Pixel> inner;
  for (const Pixel& p : pixels.pixels())
    if (p.srgba[3] == 255) inner.push_back(p);
  const double keep = std::min(1.0, double(most) / double(std::max<size_t>(inner.size(), 1)));
  std::vector<Pixel> chosen;
  for (size_t i = 0; i < inner.size(); ++i)
    if (keep == 1 || Rng(7, subset, i).uniform() < keep) chosen.push_back(inner[i]);
  std::vector<Ray> rays;
  rays.reserve(chosen.size());
  for (const Pixel& p : chosen) rays.push_back(pixels.cameras()[p.view].ray(p.x + 0.5, p.y + 0.5));
  ObjectHits out;
  std::vector<uint32_t> ray_of_hit;
  out.hits = trace_rays(device, sdf, surface, rays, ray_of_hit);
  for (size_t i = 0; i < out.hits.size(); ++i) {
    const Pixel& p = chosen[ray_of_hit[i]];
    const Camera& camera = pixels.cameras()[p.view];
    const auto channel = [&](int c) { return linear_from_srgb(float(p.srgba[c]) / 255); };
    out.colors.push_back({channel(0), channel(1), channel(2)});
    out.clipped.push_back(uint8_t((p.srgba[0] == 255) | (p.srgba[1] == 255) << 1 | (p.srgba[2] == 255) << 2));
    out.views.push_back(p.view);
    out.footprints.push_back(length(out.hits[i].position - to_float(camera.center)) / float(camera.fx));
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
