// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part.h"

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "engine/edit/handler_colors.h"
#include "engine/edit/like.h"
#include "engine/edit/material.h"
#include "engine/edit/part_pattern.h"
#include "engine/edit/part_seeds.h"
#include "engine/segment/grow.h"
#include "engine/segment/seen_points.h"
#include "model/scene/appearance.h"
#include "model/scene/handler_hits.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

constexpr float kInside = 0.5f;        // score from which a point belongs to a part
constexpr double kEverything = 0.995;  // share of the points from which a part is the whole object

constexpr const char* kInterrupted = "Selecting the part was interrupted; nothing was changed.";

std::vector<float> selected(const Device& device, const Scene& scene, const PartRequest& r,
                            std::span<const Seed> seeds, Progress& progress) {
  if (r.like) return like_scores(device, scene, r);
  if (r.network) return r.network(scene, r, progress);
  return grow(*scene.handlers, handler_colors(device, scene), seeds, r.options.graph);
}

// Score of each handler point in the existing part.
std::vector<float> existing_scores(const Scene& scene, const std::string& part) {
  const std::vector<Hit> hits = handler_hits(scene);
  const EditLayer& layer = part_layer(scene, part);
  const std::vector<uint8_t> inside = inside_layer(scene, layer, hits);
  std::vector<float> scores(inside.begin(), inside.end());
  const ScoredPoints scored = layer.region.scored();
  if (scored.empty()) return scores;
  for (size_t i = 0; i < scores.size(); ++i) {
    if (!scene.shape_versions.empty() &&
        scene.shape_versions.back()->born_in(hits[i].triangle) > layer.shape_version)
      continue;
    const SurfacePoint p = in_version(scene.shape_versions, hits[i], layer.shape_version);
    scores[i] = scored.score(p.position, p.normal);
  }
  return scores;
}

void combine(PartCombination::How how, std::span<const float> old, std::vector<float>& scores) {
  using How = PartCombination::How;
  for (size_t i = 0; i < scores.size(); ++i) {
    float& s = scores[i];
    s = how == How::add ? max(old[i], s) : how == How::subtract ? min(old[i], 1 - s) : min(old[i], s);
  }
}

// Without propagation: points that the view does not show are outside.
void keep_seen(const Scene& scene, const Camera& camera, std::vector<float>& scores) {
  constexpr float kMinFacing = 0.1f;
  const HandlerPoints& points = *scene.handlers;
  std::vector<float> seen(scores.size(), 0.0f);
  for (const SeenPoint& p :
       seen_points(*scene.surface, camera, points.positions, points.normals, kMinFacing, points.spacing))
    seen[p.point] = scores[p.point];
  scores = std::move(seen);
}

size_t count_inside(std::span<const float> scores) {
  size_t n = 0;
  for (const float s : scores) n += s >= kInside;
  return n;
}

void check_size(size_t points, size_t all, const PartRequest& r) {
  if (points == 0)
    fail("Nothing is left in part '{}'; {}.", r.name,
         r.combination ? "check what it is added to, subtracted from or intersected with"
                       : "click on its middle");
  if (double(points) >= kEverything * double(all))
    fail(
        "Part '{}' would be the whole object; add negative clicks beside it, or change the material of the "
        "whole "
        "object.",
        r.name);
}

// Gives the part one color.
void set_color(const Device& device, const Scene& scene, const PartRequest& r, Vec3f color,
               EditLayer& layer) {
  Tint tint{color, r.keep_texture, {1, 1, 1}, r.change.blend};
  if (r.keep_texture) tint.mean = mean_color_inside(device, scene, layer);
  layer.tint = tint;
}

void set_pattern(const Device& device, const Scene& scene, const PartRequest& r, EditLayer& layer,
                 Progress& progress) {
  if (r.keep_texture || r.change.blend < 1)
    fail_usage(
        "The scribble has several colors, a pattern, which replaces the texture: it cannot keep the "
        "texture or be blended. Give one color instead.");
  const std::vector<Vec2f> drawn = drawn_on_object(device, scene, r, r.scribble->positive);
  const Vec2f middle = spread(drawn, 1).front();
  const Hit hit = clicked_hits(device, scene, r, std::span(&middle, 1)).front();
  const double depth = r.camera.project(to_double(hit.position)).z;
  layer.albedo = fit_pattern(device, scene, layer, PartPattern(*r.scribble, r.camera, depth), progress);
}

void set_effects(const Device& device, const Scene& scene, const PartRequest& r, EditLayer& layer,
                 Progress& progress) {
  layer.material = r.change;
  if (r.color) return set_color(device, scene, r, *r.color, layer);
  if (!r.scribble || r.keep_color) return;
  if (r.scribble->one_color()) return set_color(device, scene, r, r.scribble->tile.rgb(0, 0), layer);
  set_pattern(device, scene, r, layer, progress);
}

SettingTable<PartOptions> make_settings() {
  SettingTable<PartOptions> table;
  const SettingGroup<PartOptions, PartOptions> part(table, "",
                                                    [](PartOptions& o) -> PartOptions& { return o; });
  part.part("graph.", &PartOptions::graph)
      .add("lightness", &GraphOptions::lightness, {0, 10}, "",
           "Weight of differences of lightness against those of hue")
      .add("crease", &GraphOptions::crease, {0, 10}, "difference of color / radian",
           "What a concave crease counts", "[Hoffman and Richards 1984]");
  part.part("like.", &PartOptions::like)
      .add("roughness", &LikeLimits::roughness, {1e-4, 1}, "", "Largest difference of roughness in a part")
      .add("metalness", &LikeLimits::metalness, {1e-4, 1}, "", "Largest difference of metalness in a part")
      .add("color", &LikeLimits::color, {1e-4, 2}, "sRGB", "Largest difference of color in a part");
  return table;
}

double vertex_share(const Scene& scene, const EditLayer& layer) {
  const std::vector<Hit> hits = vertex_hits(scene.surface->mesh());
  size_t inside = 0;
  for (const uint8_t i : inside_layer(scene, layer, hits)) inside += i;
  return double(inside) / double(std::max<size_t>(hits.size(), 1));
}

}  // namespace

const SettingTable<PartOptions>& part_settings() {
  static const SettingTable<PartOptions> table = make_settings();
  return table;
}

PartResult select_part(const Device& device, const Scene& scene, const PartRequest& r, Progress& progress) {
  if (!scene.handlers || scene.handlers->positions.empty())
    fail("The object has no handler points to select a part of; reconstruct it again.");
  check_change(r.change);
  const double start = steady_seconds();
  if (r.combination) part_layer(scene, r.combination->part);  // an error before the work
  const std::vector<Seed> seeds = r.like ? std::vector<Seed>() : part_seeds(device, scene, r);
  progress.report({"part", 0.1, -1, ""});
  const double seeded = steady_seconds();
  std::vector<float> scores = selected(device, scene, r, seeds, progress);
  check_cancelled(progress, kInterrupted);
  if (r.in_view) keep_seen(scene, r.camera, scores);
  if (r.combination) combine(r.combination->how, existing_scores(scene, r.combination->part), scores);
  PartResult result;
  result.report.points = count_inside(scores);
  check_size(result.report.points, scores.size(), r);

  const double found = steady_seconds();
  const HandlerPoints& points = *scene.handlers;
  EditLayer& layer = result.layer;
  layer.id = r.id;
  layer.part = r.name;
  layer.shape_version = scene.shape_versions.empty() ? 0 : int(scene.shape_versions.size()) - 1;
  layer.region = Region(ScoredPoints({points.positions, points.normals, std::move(scores), points.spacing}));
  result.report.share = vertex_share(scene, layer);
  set_effects(device, scene, r, layer, progress);
  result.report.seed_seconds = seeded - start;
  result.report.select_seconds = found - seeded;
  result.report.color_seconds = steady_seconds() - found;
  return result;
}

}  // namespace cei3d
