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

// what: "mask" or "scribble".
void check_size(const Image& image, const char* what, const PartRequest& r) {
  if (image.width != r.camera.width || image.height != r.camera.height)
    fail_usage("The {} is {}x{} pixels, view {} is {}x{}; draw it on an image of the view's own size.", what,
               image.width, image.height, r.view, r.camera.width, r.camera.height);
}

// Seeds of a mask: points that the view shows well, about a pixel away from the mask's border. Points on the
// border are decided by color.
std::vector<Seed> mask_seeds(const Scene& scene, const PartRequest& r) {
  check_size(r.mask, "mask", r);
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

// Rays through the drawn pixels; of many an even selection.
std::vector<Vec2f> drawn_pixels(const Image& mask) {
  constexpr size_t kMax = 20000;
  std::vector<Vec2f> all, kept;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (*mask.at(x, y) > 0) all.push_back({float(x) + 0.5f, float(y) + 0.5f});
  const size_t step = all.size() / kMax + 1;
  for (size_t i = 0; i < all.size(); i += step) kept.push_back(all[i]);
  return kept;
}

// The object in the drawn pixels.
struct Drawn {
  std::vector<Vec2f> pixels;
  std::vector<SurfacePoint> points;  // #pixels
};

Drawn drawn_in(const Device& device, const Scene& scene, const PartRequest& r, const Image& mask) {
  constexpr float kMinFacing = 0.1f;
  const std::vector<Vec2f> pixels = drawn_pixels(mask);
  std::vector<Ray> rays;
  for (const Vec2f p : pixels) rays.push_back(r.camera.ray(p.x, p.y));
  std::vector<uint32_t> ray_of_hit;
  const std::vector<Hit> hits = trace_rays(device, scene, rays, ray_of_hit);
  Drawn drawn;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (dot(hits[i].normal, hits[i].to_camera) <= kMinFacing) continue;
    drawn.pixels.push_back(pixels[ray_of_hit[i]]);
    drawn.points.push_back({hits[i].position, hits[i].normal});
  }
  return drawn;
}

std::vector<Seed> scribble_seeds(const Device& device, const Scene& scene, const PartRequest& r) {
  check_size(r.scribble->positive, "scribble", r);
  std::vector<SurfacePoint> positive = drawn_in(device, scene, r, r.scribble->positive).points,
                            negative = drawn_in(device, scene, r, r.scribble->negative).points;
  if (positive.empty())
    fail("The scribble shows nothing of the object in view {}; is it the right view?", r.view);
  for (const SurfacePoint& p : clicked_points(device, scene, r, r.clicks.positive)) positive.push_back(p);
  for (const SurfacePoint& p : clicked_points(device, scene, r, r.clicks.negative)) negative.push_back(p);
  const std::vector<Seed> seeds = stroke_seeds(*scene.handlers, positive, negative);
  if (std::find(seeds.begin(), seeds.end(), Seed::positive) == seeds.end())
    fail_usage("Negative strokes cover the whole scribble; take them away from the part.");
  return seeds;
}

}  // namespace

std::vector<Vec2f> drawn_on_object(const Device& device, const Scene& scene, const PartRequest& r,
                                   const Image& mask) {
  return drawn_in(device, scene, r, mask).pixels;
}

Prompts network_prompts(const Device& device, const Scene& scene, const PartRequest& r) {
  constexpr size_t kOfStrokes = 5;
  Prompts prompts = r.clicks;
  if (!r.scribble) return prompts;
  const auto add = [&](const Image& mask, std::vector<Vec2f>& to) {
    const std::vector<Vec2f> some = spread(drawn_on_object(device, scene, r, mask), kOfStrokes);
    to.insert(to.end(), some.begin(), some.end());
  };
  add(r.scribble->positive, prompts.positive);
  add(r.scribble->negative, prompts.negative);
  return prompts;
}

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
  if (r.scribble) return scribble_seeds(device, scene, r);
  if (r.clicks.positive.empty())
    fail_usage("Say where the part is: a positive click on it, a scribble or a mask.");
  return click_seeds(*scene.handlers, clicked_points(device, scene, r, r.clicks.positive),
                     clicked_points(device, scene, r, r.clicks.negative));
}

}  // namespace cei3d
