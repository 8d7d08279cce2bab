// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_seeds.h"

#include <algorithm>

#include "core/base/error.h"
#include "engine/render/render.h"
#include "engine/segment/grow.h"
#include "engine/segment/seen_points.h"

namespace cei3d {
namespace {

std::vector<SurfacePoint> clicked_points(const Device& device, const Scene& scene, const PartRequest& r,
                                         std::span<const Vec2f> pixels) {
  std::vector<SurfacePoint> points;
  for (const Hit& h : clicked_hits(device, scene, r, pixels)) points.push_back({h.position, h.normal});
  return points;
}

void check_pixel(Vec2f p, const PartRequest& r) {
  if (!(p.x >= 0 && p.y >= 0 && p.x <= float(r.camera.width) && p.y <= float(r.camera.height)))
    fail_usage("Click {:.6g},{:.6g} is not in view {}, which is {}x{}.", p.x, p.y, r.view, r.camera.width,
               r.camera.height);
}

// Seeds of a mask: points that the view shows well, about a pixel away from the mask's border. Points on the
// border are decided by color.
std::vector<Seed> mask_seeds(const Scene& scene, const PartRequest& r) {
  if (r.mask.width != r.camera.width || r.mask.height != r.camera.height)
    fail_usage("The mask is {}x{} pixels, view {} is {}x{}; draw it on an image of the view's own size.",
               r.mask.width, r.mask.height, r.view, r.camera.width, r.camera.height);
  constexpr float kMinFacing = 0.2f, kMargin = 1;
  const HandlerPoints& points = *scene.handlers;
  std::vector<Seed> seeds(points.positions.size(), Seed::none);
  for (const SeenPoint& p :
       seen_points(*scene.surface, r.camera, points.positions, points.normals, kMinFacing, points.spacing)) {
    int inside = 0;
    for (const Vec2f d : {Vec2f{0, 0}, {kMargin, 0}, {-kMargin, 0}, {0, kMargin}, {0, -kMargin}})
      inside += sample(r.mask, {p.pixel.x + d.x, p.pixel.y + d.y}) >= 0.5f;
    if (inside == 5) seeds[p.point] = Seed::positive;
    if (inside == 0) seeds[p.point] = Seed::negative;
  }
  if (std::find(seeds.begin(), seeds.end(), Seed::positive) == seeds.end())
    fail("The mask shows nothing of the object in view {}; is it the right view?", r.view);
  return seeds;
}

}  // namespace

std::vector<Hit> clicked_hits(const Device& device, const Scene& scene, const PartRequest& r,
                              std::span<const Vec2f> pixels) {
  std::vector<Ray> rays;
  for (const Vec2f p : pixels) {
    check_pixel(p, r);
    rays.push_back(r.camera.ray(p.x, p.y));
  }
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, scene, rays, ray_of_hit);
  for (size_t i = 0; i < pixels.size(); ++i)
    if (i >= ray_of_hit.size() || ray_of_hit[i] != i)
      fail("View {} shows the background at {:.6g},{:.6g}; click on the object.", r.view, pixels[i].x,
           pixels[i].y);
  return hits;
}

std::vector<Seed> part_seeds(const Device& device, const Scene& scene, const PartRequest& r) {
  if (!r.mask.empty()) return mask_seeds(scene, r);
  if (r.clicks.positive.empty()) fail_usage("Give a --positive click on the part, or a --mask.");
  return click_seeds(*scene.handlers, clicked_points(device, scene, r, r.clicks.positive),
                     clicked_points(device, scene, r, r.clicks.negative));
}

}  // namespace cei3d
