// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/surface_and_hits.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/math/rng.h"
#include "engine/reconstruct/edge_pixels.h"
#include "engine/render/render.h"

namespace cei3d {

namespace {

// Pixels traced at a time: tracing takes more memory than the hits do, and with the largest networks 5 s of
// one core.
constexpr size_t kSlab = 1 << 13;
constexpr float kHandlerSpacing = 1.5f;  // spacing of handler points, in pixels
// Share of the pixels at edges that are kept, for the sake of bars so thin that they have no others.
constexpr float kEdgeShare = 0.125f;
constexpr size_t kFewPixels = 50000;  // captures with fewer pixels on the object keep all

bool inside(const Pixel& p) { return p.srgba[3] == 255; }

size_t count_inside(const PixelStore& pixels) {
  return size_t(std::count_if(pixels.pixels().begin(), pixels.pixels().end(), inside));
}

// Calls use(index) for the pixels wholly on the object, or for a random subset of them.
template <class Use>
void for_chosen_pixels(const PixelStore& pixels, const HitOptions& options, const Use& use) {
  const double inner = double(std::max<size_t>(count_inside(pixels), 1)),
               keep = std::min(1.0, double(options.max_hits) / inner);
  size_t i = 0;
  for (size_t pixel = 0; pixel < pixels.pixels().size(); ++pixel) {
    if (!inside(pixels.pixels()[pixel])) continue;
    if (keep == 1 || Rng(7, options.subset, i).uniform() < keep) use(pixel);
    ++i;
  }
}

void add_hit(const PixelStore& pixels, size_t pixel, const Hit& hit, ObjectHits& out) {
  const uint16_t view = pixels.pixels()[pixel].view;
  const Camera& camera = pixels.cameras()[view];
  out.hits.push_back(hit);
  out.colors.push_back(pixels.radiance(pixel));
  out.clipped.push_back(pixels.clipped(pixel));
  out.views.push_back(view);
  out.footprints.push_back(length(hit.position - to_float(camera.center)) / float(camera.fx));
}

// Traces the pixels of the slab (indices) and empties it. edge_share: of the pixels at edges, kept at random.
void add_hits(const Device& device, const Field& sdf, const Surface& surface, const PixelStore& pixels,
              float edge_share, std::vector<size_t>& slab, ObjectHits& out) {
  std::vector<Ray> rays;
  rays.reserve(slab.size());
  for (const size_t i : slab) rays.push_back(pixels.ray(pixels.pixels()[i]));
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, sdf, surface, rays, ray_of_hit);
  std::vector<size_t> pixel_of;
  for (const uint32_t ray : ray_of_hit) pixel_of.push_back(slab[ray]);
  std::vector<SeenAt> seen;
  for (const size_t i : pixel_of) {
    const Pixel& p = pixels.pixels()[i];
    seen.push_back({p.view, p.x, p.y});
  }
  const std::vector<uint8_t> edge = on_edges(surface, pixels.cameras(), hits, seen);
  for (size_t i = 0; i < hits.size(); ++i)
    if (!edge[i] || Rng(8, 0, pixel_of[i]).uniform() < edge_share) add_hit(pixels, pixel_of[i], hits[i], out);
  slab.clear();
}

}  // namespace

ObjectHits object_rays(const PixelStore& pixels, const HitOptions& options) {
  ObjectHits out;
  for_chosen_pixels(pixels, options, [&](size_t pixel) {
    const Ray ray = pixels.ray(pixels.pixels()[pixel]);
    const Vec3f nearest = ray.origin - ray.direction * dot(ray.origin, ray.direction);
    add_hit(pixels, pixel, {nearest, {0, 0, 1}, -ray.direction, 0, 0, 0}, out);
  });
  return out;
}

ObjectHits object_hits(const Device& device, const Field& sdf, const Surface& surface,
                       const PixelStore& pixels, const HitOptions& options, const Progress& progress) {
  ObjectHits out;
  const auto reserve = [n = std::min(options.max_hits, pixels.pixels().size())](auto&... lists) {
    (lists.reserve(n), ...);
  };
  reserve(out.hits, out.colors, out.clipped, out.views, out.footprints);
  const float edge_share = count_inside(pixels) < kFewPixels ? 1 : kEdgeShare;
  std::vector<size_t> slab;
  const auto trace = [&] {
    check_cancelled(progress);
    add_hits(device, sdf, surface, pixels, edge_share, slab, out);
  };
  for_chosen_pixels(pixels, options, [&](size_t pixel) {
    slab.push_back(pixel);
    if (slab.size() == kSlab) trace();
  });
  if (!slab.empty()) trace();
  return out;
}

std::shared_ptr<const Surface> extract_surface(const Device& device, const Field& sdf,
                                               const MeshingOptions& meshing, const Progress& progress) {
  Mesh mesh = extract_mesh(device, sdf, meshing, progress);
  return std::make_shared<const Surface>(std::move(mesh), progress);
}

SurfaceAndHits extract_surface_and_hits(const Device& device, const Field& sdf, const MeshingOptions& meshing,
                                        const PixelStore& pixels, size_t max_hits, const Progress& progress) {
  SurfaceAndHits s;
  s.surface = extract_surface(device, sdf, meshing, progress);
  s.hits = object_hits(device, sdf, *s.surface, pixels, {max_hits}, progress);
  if (s.hits.hits.empty()) fail("No training image shows the reconstructed surface.");
  return s;
}

std::shared_ptr<const HandlerPoints> handlers_of(const ObjectHits& hits, double footprint) {
  return std::make_shared<const HandlerPoints>(
      thin_hits(hits.hits, hits.footprints, kHandlerSpacing * float(footprint)));
}

}  // namespace cei3d
